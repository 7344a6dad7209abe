#include "tests/support/shaped_samples.h"

#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

ShapedSample named(const char* name, OutputShape shape, int frame_count) {
  ShapedSample s;
  s.name = s.info.system = name;
  s.info.content.shape = shape;
  s.info.first_frame = 1001;
  s.info.frame_count = frame_count;
  s.info.metadata = {{"inputs", "0123456789abcdef"}, {"units", "m"}};
  return s;
}

/// Sixteenths that differ between frames and elements; the fifth frame rests.
Vec3f place(int frame, std::uint64_t id) {
  const int t = frame == 4 ? 3 : frame, k = (7 * static_cast<int>(id) + 13 * t) % 32;
  return Vec3f(static_cast<float>(2 * t), static_cast<float>(k), static_cast<float>(16 - k)) / 16;
}

void move(FrameData& f, int frame, std::uint64_t id) {
  f.positions.push_back(place(frame, id));
  f.velocities.push_back(place(frame, id + 5) - Vec3f(1, 1, 0));
}

}  // namespace

ShapedSample sheet(int frame_count) {
  const CacheSample patch = waving_patch(2, 1, frame_count);
  ShapedSample s = named("sheet", OutputShape::k_mesh, frame_count);
  s.info = patch.info;
  for (std::size_t i = 0; i < patch.positions.size(); ++i) {
    FrameData& f = s.frames.emplace_back();
    for (const Vec3& p : patch.positions[i]) f.positions.push_back(p.cast<float>());
    for (const Vec3& v : patch.velocities[i]) f.velocities.push_back(v.cast<float>());
  }
  return s;
}

ShapedSample pool(int frame_count) {
  ShapedSample s = sheet(frame_count);
  s.name = s.info.system = s.info.mesh.name = "pool";
  s.info.content.scalars = {"foam", "wet; \"nearly\""};
  for (int i = 0; i < frame_count; ++i) {
    FrameData& f = s.frames[at(i)];
    f.scalars.resize(2);
    for (std::uint64_t v = 0; v < f.positions.size(); ++v) {
      f.scalars[0].push_back(i < 3 ? 0 : (place(i, v).y() + 2) / 4);  // none for a while
      f.scalars[1].push_back(static_cast<float>(v) / 64);             // never another
    }
  }
  return s;
}

ShapedSample splash(int frame_count) {
  ShapedSample s = named("splash", OutputShape::k_mesh, frame_count);
  s.info.content.changes = true;
  s.info.content.scalars = {"foam"};
  for (int i = 0; i < frame_count; ++i) {
    FrameData& f = s.frames.emplace_back();
    const int rows = (i == 4 ? 3 : i) % 4;  // of two vertices each, a quad between two, a triangle at the end
    f.scalars.resize(1);
    for (int v = 0; v < 2 * rows; ++v) {
      move(f, i, static_cast<std::uint64_t>(v));
      f.scalars[0].push_back(static_cast<float>(v * rows) / 32);
    }
    for (int q = 0; q + 1 < rows; ++q) {
      f.face_sizes.push_back(q % 2 == 0 ? 4 : 3);
      for (const int v : {2 * q, 2 * q + 1, 2 * q + 3, 2 * q + 2})
        if (f.face_sizes.back() == 4 || v != 2 * q + 2) f.face_vertices.push_back(v);
    }
  }
  return s;
}

ShapedSample strands(int frame_count) {
  ShapedSample s = named("strands", OutputShape::k_curves, frame_count);
  CurveSet& c = s.info.curves;
  c.vertices_per_curve = {4, 2, 3};
  c.ids = {11, 7, 2000000000};
  for (int v = 0; v < 9; ++v) {
    c.rest.push_back(place(0, static_cast<std::uint64_t>(v + 40)).cast<double>());
    c.widths.push_back(static_cast<float>(9 - v) / 1024);
  }
  s.info.attributes = {
      {"groom_version_major", AttributeScope::k_all, std::vector<std::int16_t>{1}},
      {"groom_group_id", AttributeScope::k_each, std::vector<std::int32_t>{0, 0, -1}},
      {"groom_root_uv", AttributeScope::k_each, std::vector<Eigen::Vector2f>{{0.25f, 0.5f}, {0.75f, 0}, {1, 0.125f}}},
      {"groom_width", AttributeScope::k_vertex, c.widths},
      {"groom_group_name", AttributeScope::k_each, std::vector<std::string>{"fringe", "", "neck; left"}}};
  for (int i = 0; i < frame_count; ++i) {
    FrameData& f = s.frames.emplace_back();
    for (std::uint64_t v = 0; v < 9; ++v) move(f, i, v);
  }
  return s;
}

ShapedSample spray(int frame_count) {
  ShapedSample s = named("spray", OutputShape::k_points, frame_count);
  s.info.content.changes = s.info.content.widths = true;
  for (int i = 0; i < frame_count; ++i) {
    FrameData& f = s.frames.emplace_back();
    const int t = i == 4 ? 3 : i;
    if (t == 0 || t == 6) continue;  // nothing there yet; nothing there any more
    for (std::uint64_t id = static_cast<std::uint64_t>(t / 2); id < static_cast<std::uint64_t>(2 * t); ++id) {
      const std::uint64_t big = id % 3 == 0 ? id + (std::uint64_t{1} << 40) : id;  // in no order, beyond 32 bits
      f.ids.push_back(big);
      f.widths.push_back(static_cast<float>(id + 1) / 256);
      move(f, i, id);
    }
  }
  return s;
}

ShapedSample leaves(int frame_count) {
  ShapedSample s = named("leaves", OutputShape::k_instances, frame_count);
  s.info.content.angular_velocities = s.info.content.scales = true;
  s.info.instances = {{3, 1, 4, 15}, {1, 0, 0, 1}, {"maple", "oak"}};
  s.info.attributes = {{"tree", AttributeScope::k_each, std::vector<std::int32_t>{9, 9, 8, 8}},
                       {"season", AttributeScope::k_all, std::vector<std::string>{"autumn"}}};
  for (int i = 0; i < frame_count; ++i) {
    FrameData& f = s.frames.emplace_back();
    for (std::uint64_t id = 0; id < 4; ++id) {
      move(f, i, id);
      const float angle = static_cast<float>(i == 4 ? 3 : i) / 8 + static_cast<float>(id);
      f.orientations.emplace_back(Eigen::AngleAxisf(angle, Vec3f(0.6f, 0, 0.8f)));
      f.angular_velocities.push_back(place(i, id + 9));
      f.scales.push_back(id == 2 ? Vec3f::Zero() : Vec3f(1, 0.5f, 2));  // the third is not there
    }
  }
  return s;
}

std::vector<ShapedSample> all_shapes(int frame_count) {
  return {sheet(frame_count),   pool(frame_count),  splash(frame_count),
          strands(frame_count), spray(frame_count), leaves(frame_count)};
}

Status write_shaped(const CacheFormat& format, const std::filesystem::path& path, const ShapedSample& sample, int end,
                    int keep_frames) {
  auto writer = format.open_writer(path, sample.info, keep_frames);
  if (!writer) return writer.error();
  for (int f = (*writer)->frame_count(); f < end; ++f)
    if (const Status written = (*writer)->write_frame(sample.frames[at(f)].view()); !written) return written;
  return (*writer)->close();
}

}  // namespace ft::test

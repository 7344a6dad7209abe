// Character <-> bytes: magic, version, hash of the payload, payload. The import cache stores these files, and the
// importing child process hands its result over in them.
#include "io/import/character/character.h"

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_magic = 0x3152414843544646ull;  // "FFTCHAR1"
constexpr std::uint32_t k_version = 3;

template <class T>
void put_vector(ByteWriter& out, const std::vector<T>& values) {
  out.write(static_cast<std::uint64_t>(values.size())).write_array(std::span<const T>(values));
}
template <class T>
std::vector<T> get_vector(ByteReader& in) {
  return in.read_array<T>(in.read<std::uint64_t>());
}

void put_points(ByteWriter& out, const std::vector<Vec3>& points) {
  out.write(static_cast<std::uint64_t>(points.size()));
  out.write_raw(points.data(), points.size() * sizeof(Vec3));
}
std::vector<Vec3> get_points(ByteReader& in) {
  const auto count = in.read<std::uint64_t>();
  if (count > in.remaining() / sizeof(Vec3)) {
    in.fail();
    return {};
  }
  const auto raw = in.read_span(count * sizeof(Vec3));
  std::vector<Vec3> points(raw.size() / sizeof(Vec3));
  if (!raw.empty()) std::memcpy(static_cast<void*>(points.data()), raw.data(), raw.size());
  return points;
}

template <class Matrix>
void put_matrix(ByteWriter& out, const Matrix& m) {
  out.write_raw(m.data(), sizeof(double) * static_cast<std::size_t>(m.size()));
}
template <class Matrix>
Matrix get_matrix(ByteReader& in) {
  Matrix m;
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = in.read<double>();
  return m;
}

/// Number of records that follow; each takes at least `least` bytes, so a lie is found before anything is allocated.
std::size_t get_count(ByteReader& in, std::size_t least) {
  const auto count = in.read<std::uint64_t>();
  if (count > in.remaining() / least) {
    in.fail();
    return 0;
  }
  return static_cast<std::size_t>(count);
}

void put_track(ByteWriter& out, const Track& track) {
  out.write(static_cast<std::uint8_t>(track.interpolation)).write(static_cast<std::int32_t>(track.width));
  put_vector(out, track.times);
  put_vector(out, track.values);
}
Track get_track(ByteReader& in) {
  Track track;
  track.interpolation = static_cast<KeyInterpolation>(in.read<std::uint8_t>());
  track.width = in.read<std::int32_t>();
  track.times = get_vector<double>(in);
  track.values = get_vector<double>(in);
  return track;
}

void put_curve(ByteWriter& out, const Curve& curve) {
  put_vector(out, curve.times);
  put_vector(out, curve.values);
  put_vector(out, curve.interpolation);
  put_vector(out, curve.handles);
  for (const CurveEnd* end : {&curve.before, &curve.after})
    out.write(static_cast<std::uint8_t>(end->rule)).write(end->count);
}
Curve get_curve(ByteReader& in) {
  Curve curve;
  curve.times = get_vector<double>(in);
  curve.values = get_vector<double>(in);
  curve.interpolation = get_vector<CurveInterpolation>(in);
  curve.handles = get_vector<CurveHandles>(in);
  for (CurveEnd* end : {&curve.before, &curve.after}) {
    end->rule = static_cast<CurveInfinity>(in.read<std::uint8_t>());
    end->count = in.read<std::int32_t>();
  }
  return curve;
}

void put_numbers(ByteWriter& out, const AnimatedNumbers& numbers) {
  put_matrix(out, numbers.rest);
  out.write(static_cast<std::uint64_t>(numbers.layers.size()));
  for (const LayeredNumbers& said : numbers.layers) {
    out.write(said.layer);
    put_matrix(out, said.fixed);
    for (const std::int32_t curve : said.curves) out.write(curve);
  }
}
AnimatedNumbers get_numbers(ByteReader& in) {
  AnimatedNumbers numbers;
  numbers.rest = get_matrix<Vec3>(in);
  numbers.layers.resize(get_count(in, 4 + sizeof(Vec3) + 12));
  for (LayeredNumbers& said : numbers.layers) {
    said.layer = in.read<std::int32_t>();
    said.fixed = get_matrix<Vec3>(in);
    for (std::int32_t& curve : said.curves) curve = in.read<std::int32_t>();
  }
  return numbers;
}

void put_stack(ByteWriter& out, const TransformStack& stack) {
  out.write(stack.node).write(static_cast<std::uint8_t>(stack.inheritance));
  out.write(static_cast<std::uint64_t>(stack.elements.size()));
  for (const ElementaryTransform& e : stack.elements) {
    out.write(static_cast<std::uint8_t>(e.kind)).write(static_cast<std::uint8_t>(e.order));
    if (e.kind == TransformKind::k_matrix) {
      put_matrix(out, e.matrix);
      continue;
    }
    out.write(static_cast<std::uint8_t>(e.inverted)).write(e.unit);
    put_matrix(out, e.axis);
    put_numbers(out, e.numbers);
  }
}
TransformStack get_stack(ByteReader& in) {
  TransformStack stack;
  stack.node = in.read<std::int32_t>();
  stack.inheritance = static_cast<ScaleInheritance>(in.read<std::uint8_t>());
  stack.elements.resize(get_count(in, 2 + sizeof(Vec3)));
  for (ElementaryTransform& e : stack.elements) {
    e.kind = static_cast<TransformKind>(in.read<std::uint8_t>());
    e.order = static_cast<RotationOrder>(in.read<std::uint8_t>());
    if (e.kind == TransformKind::k_matrix) {
      e.matrix = get_matrix<Mat4>(in);
      continue;
    }
    e.inverted = in.read<std::uint8_t>() != 0;
    e.unit = in.read<double>();
    e.axis = get_matrix<Vec3>(in);
    e.numbers = get_numbers(in);
  }
  return stack;
}

void put_clip(ByteWriter& out, const Clip& clip) {
  out.write_string(clip.name).write(clip.start).write(clip.end).write(static_cast<std::uint8_t>(clip.has_own_range));
  out.write(static_cast<std::uint64_t>(clip.channels.size()));
  for (const Channel& channel : clip.channels) {
    out.write(static_cast<std::int32_t>(channel.node));
    for (const Track* t : {&channel.translation, &channel.rotation, &channel.scale, &channel.weights})
      put_track(out, *t);
  }
  out.write(static_cast<std::uint64_t>(clip.curves.curves.size()));
  for (const Curve& curve : clip.curves.curves) put_curve(out, curve);
  out.write(static_cast<std::uint64_t>(clip.curves.layers.size()));
  for (const AnimationLayer& layer : clip.curves.layers)
    out.write(static_cast<std::uint8_t>(layer.mode))
        .write(layer.weight)
        .write(layer.weight_curve)
        .write(static_cast<std::uint8_t>(layer.composes_rotations))
        .write(static_cast<std::uint8_t>(layer.multiplies_scales));
  out.write(static_cast<std::uint64_t>(clip.stacks.size()));
  for (const TransformStack& stack : clip.stacks) put_stack(out, stack);
  out.write(static_cast<std::uint64_t>(clip.shapes.size()));
  for (const ShapeChannel& channel : clip.shapes) {
    out.write(channel.node).write(static_cast<std::uint64_t>(channel.shapes.size()));
    for (const ShapeChannel::Shape& shape : channel.shapes) out.write(shape.morph).write(shape.full);
    put_numbers(out, channel.percent);
  }
}
Clip get_clip(ByteReader& in) {
  Clip clip;
  clip.name = in.read_string();
  clip.start = in.read<double>();
  clip.end = in.read<double>();
  clip.has_own_range = in.read<std::uint8_t>() != 0;
  clip.channels.resize(get_count(in, 4 + 4 * 21));
  for (Channel& channel : clip.channels) {
    channel.node = in.read<std::int32_t>();
    for (Track* t : {&channel.translation, &channel.rotation, &channel.scale, &channel.weights}) *t = get_track(in);
  }
  clip.curves.curves.resize(get_count(in, 4 * 8 + 10));
  for (Curve& curve : clip.curves.curves) curve = get_curve(in);
  clip.curves.layers.resize(get_count(in, 15));
  for (AnimationLayer& layer : clip.curves.layers) {
    layer.mode = static_cast<LayerMode>(in.read<std::uint8_t>());
    layer.weight = in.read<double>();
    layer.weight_curve = in.read<std::int32_t>();
    layer.composes_rotations = in.read<std::uint8_t>() != 0;
    layer.multiplies_scales = in.read<std::uint8_t>() != 0;
  }
  clip.stacks.resize(get_count(in, 13));
  for (TransformStack& stack : clip.stacks) stack = get_stack(in);
  clip.shapes.resize(get_count(in, 12 + sizeof(Vec3) + 8));
  for (ShapeChannel& channel : clip.shapes) {
    channel.node = in.read<std::int32_t>();
    channel.shapes.resize(get_count(in, 12));
    for (ShapeChannel::Shape& shape : channel.shapes) {
      shape.morph = in.read<std::int32_t>();
      shape.full = in.read<double>();
    }
    channel.percent = get_numbers(in);
  }
  return clip;
}

void put_mesh(ByteWriter& out, const CharacterMesh& mesh) {
  out.write_string(mesh.name)
      .write(static_cast<std::int32_t>(mesh.node))
      .write(static_cast<std::uint8_t>(mesh.visible));
  put_points(out, mesh.positions);
  put_vector(out, mesh.triangles);
  out.write(static_cast<std::uint64_t>(mesh.bones.size()));
  for (const SkinBone& bone : mesh.bones) {
    out.write(static_cast<std::int32_t>(bone.node));
    put_matrix(out, bone.inverse_bind);
  }
  put_vector(out, mesh.influence_start);
  put_vector(out, mesh.influence_bone);
  put_vector(out, mesh.influence_weight);
  put_vector(out, mesh.dual_share);
  out.write(static_cast<std::uint64_t>(mesh.morphs.size()));
  for (const MorphTarget& morph : mesh.morphs) {
    out.write_string(morph.name);
    put_points(out, morph.deltas);
  }
}
CharacterMesh get_mesh(ByteReader& in) {
  CharacterMesh mesh;
  mesh.name = in.read_string();
  mesh.node = in.read<std::int32_t>();
  mesh.visible = in.read<std::uint8_t>() != 0;
  mesh.positions = get_points(in);
  mesh.triangles = get_vector<Triangle>(in);
  mesh.bones.resize(get_count(in, 4 + sizeof(Mat4)));
  for (SkinBone& bone : mesh.bones) {
    bone.node = in.read<std::int32_t>();
    bone.inverse_bind = get_matrix<Mat4>(in);
  }
  mesh.influence_start = get_vector<int>(in);
  mesh.influence_bone = get_vector<int>(in);
  mesh.influence_weight = get_vector<double>(in);
  mesh.dual_share = get_vector<double>(in);
  mesh.morphs.resize(get_count(in, 12));
  for (MorphTarget& morph : mesh.morphs) {
    morph.name = in.read_string();
    morph.deltas = get_points(in);
  }
  return mesh;
}

}  // namespace

Bytes save_character(const Character& character) {
  ByteWriter out;
  out.write_string(character.format).write(character.file_unit);
  put_matrix(out, character.file_axes);
  out.write_string(character.file_up);
  out.write(static_cast<std::uint64_t>(character.nodes.size()));
  for (const CharacterNode& node : character.nodes) {
    out.write_string(node.name).write(static_cast<std::int32_t>(node.parent));
    put_matrix(out, node.local);
    put_vector(out, node.morph_weights);
  }
  out.write(static_cast<std::uint64_t>(character.meshes.size()));
  for (const CharacterMesh& mesh : character.meshes) put_mesh(out, mesh);
  out.write(static_cast<std::uint64_t>(character.clips.size()));
  for (const Clip& clip : character.clips) put_clip(out, clip);
  out.write(static_cast<std::uint64_t>(character.dependencies.size()));
  for (const Dependency& d : character.dependencies) out.write_string(d.path).write(d.hash.low).write(d.hash.high);
  out.write(static_cast<std::uint64_t>(character.contents.size()));
  for (const CharacterContent& content : character.contents)
    out.write_string(content.what).write(content.count).write_string(content.use);
  out.write(static_cast<std::uint64_t>(character.notes.size()));
  for (const std::string& note : character.notes) out.write_string(note);

  const Bytes payload = out.take();
  const Hash128 hash = hash_bytes(payload);
  ByteWriter file;
  file.write(k_magic).write(k_version).write(hash.low).write(hash.high).write(
      static_cast<std::uint64_t>(payload.size()));
  file.write_raw(payload.data(), payload.size());
  return file.take();
}

Result<Character> load_character_bytes(std::span<const std::byte> data) {
  ByteReader head(data);
  const bool ours = head.read<std::uint64_t>() == k_magic && head.read<std::uint32_t>() == k_version;
  const auto low = head.read<std::uint64_t>(), high = head.read<std::uint64_t>();
  const auto size = head.read<std::uint64_t>();
  if (!head.ok() || !ours) return input_error("is not an import result of this version");
  if (size != head.remaining()) return input_error("import result is cut or too long");
  const auto payload = head.read_span(size);
  if (hash_bytes(payload) != Hash128{low, high}) return input_error("import result is damaged");

  ByteReader in(payload);
  Character c;
  c.format = in.read_string();
  c.file_unit = in.read<double>();
  c.file_axes = get_matrix<Mat3>(in);
  c.file_up = in.read_string();
  c.nodes.resize(get_count(in, 4 + 4 + sizeof(Mat4)));
  for (CharacterNode& node : c.nodes) {
    node.name = in.read_string();
    node.parent = in.read<std::int32_t>();
    node.local = get_matrix<Mat4>(in);
    node.morph_weights = get_vector<double>(in);
  }
  c.meshes.resize(get_count(in, 32));
  for (CharacterMesh& mesh : c.meshes) mesh = get_mesh(in);
  c.clips.resize(get_count(in, 24));
  for (Clip& clip : c.clips) clip = get_clip(in);
  c.dependencies.resize(get_count(in, 20));
  for (Dependency& d : c.dependencies) {
    d.path = in.read_string();
    d.hash.low = in.read<std::uint64_t>();
    d.hash.high = in.read<std::uint64_t>();
  }
  c.contents.resize(get_count(in, 16));
  for (CharacterContent& content : c.contents) {
    content.what = in.read_string();
    content.count = in.read<std::int64_t>();
    content.use = in.read_string();
  }
  c.notes.resize(get_count(in, 4));
  for (std::string& note : c.notes) note = in.read_string();
  if (!in.ok() || in.remaining() != 0) return input_error("import result is cut or too long");
  if (Status s = check_character(c); !s) return s.error();
  return c;
}

}  // namespace ft::inline io

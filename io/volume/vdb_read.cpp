#include "io/volume/vdb_read.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_magic = 0x3130'6264'7674'66;  // "ftvdb01"
constexpr const char* k_reader = "followthrough_read_vdb";

/// Empty when it is not there.
std::filesystem::path find_reader(const VdbOptions& options) {
  std::error_code failed;
  auto reader = options.reader;
  if (reader.empty()) reader = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path() / k_reader;
  return !failed && std::filesystem::is_regular_file(reader, failed) ? reader : std::filesystem::path();
}

/// What stands for the number in a file's name: #### or %04d. Nothing: {npos, 0}.
std::pair<std::size_t, std::size_t> number_mark(const std::string& name) {
  if (const auto last = name.find_last_of('#'); last != std::string::npos) {
    std::size_t begin = last;
    while (begin > 0 && name[begin - 1] == '#') --begin;
    return {begin, last + 1 - begin};
  }
  for (std::size_t begin = name.find('%'); begin != std::string::npos; begin = name.find('%', begin + 1)) {
    std::size_t end = begin + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    if (end < name.size() && name[end] == 'd') return {begin, end + 1 - begin};
  }
  return {std::string::npos, 0};
}

}  // namespace

Result<VdbVelocity> read_vdb_velocity(const std::filesystem::path& file, const std::string& grid,
                                      const VdbOptions& options) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return input_error("file does not exist", file.string());
  ChildTask task;
  task.program = find_reader(options), task.file = file;
  task.last = {grid, std::to_string(options.most_voxels)};
  if (task.program.empty())
    return input_error(std::string("cannot be read without the program ") + k_reader, file.string(),
                       "it is built and installed with followthrough, and has to be in the same folder");
  const auto bytes = read_in_child(task, options.limits);
  if (!bytes) return bytes.error();
  auto velocity = load_vdb(*bytes);
  if (!velocity) return damaged_child_result(task, velocity.error().what);
  return velocity;
}

Result<NumberedFiles> find_vdb_sequence(const std::filesystem::path& pattern) {
  const std::string name = pattern.filename().string();
  const auto [begin, size] = number_mark(name);
  if (begin != std::string::npos) return numbered_files(pattern, name.substr(0, begin), name.substr(begin + size));
  std::error_code failed;
  if (!std::filesystem::is_regular_file(pattern, failed)) return input_error("file does not exist", pattern.string());
  return NumberedFiles{0, {pattern}};
}

Result<std::vector<VdbVelocity>> read_vdb_sequence(const NumberedFiles& sequence, const std::string& grid,
                                                   const VdbOptions& options, std::int64_t most_voxels) {
  std::vector<VdbVelocity> out;
  std::int64_t voxels = 0;
  for (const auto& file : sequence.files) {
    auto frame = read_vdb_velocity(file, grid, options);
    if (!frame) return frame.error();
    voxels += static_cast<std::int64_t>(frame->velocities.size());
    if (voxels > most_voxels)
      return input_error("the sequence has more than " + std::to_string(most_voxels) + " voxels up to here",
                         file.string(), "export coarser grids, or fewer frames");
    out.push_back(std::move(*frame));
  }
  return out;
}

void to_metres(VdbVelocity& velocity, double unit_scale, std::string_view up) {
  Mat3 change = unit_scale * Mat3::Identity();
  if (up == "z") change = unit_scale * (Mat3() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
  velocity.to_world = Eigen::Affine3d(change) * velocity.to_world;
  const Mat3f turn = change.cast<float>();
  for (Vec3f& v : velocity.velocities) v = turn * v;
}

Bytes vdb_head(const VdbVelocity& velocity) {
  ByteWriter out;
  out.write(k_magic).write(velocity.lowest).write(velocity.count);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) out.write(velocity.to_world(row, column));
  out.write_string(velocity.grid).write(static_cast<std::uint32_t>(velocity.notes.size()));
  for (const std::string& note : velocity.notes) out.write_string(note);
  return out.take();
}

Result<VdbVelocity> load_vdb(std::span<const std::byte> bytes) {
  const Error wrong = input_error("the reader's result is damaged");
  ByteReader in(bytes);
  VdbVelocity out;
  out.to_world.setIdentity();
  if (in.read<std::uint64_t>() != k_magic) return wrong;
  for (int& i : out.lowest) i = in.read<int>();
  for (int& n : out.count) n = in.read<int>();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) out.to_world(row, column) = in.read<double>();
  out.grid = in.read_string();
  for (auto notes = in.read<std::uint32_t>(); in.ok() && notes > 0; --notes) out.notes.push_back(in.read_string());
  std::uint64_t voxels = 1;
  const std::uint64_t most = in.remaining() / sizeof(Vec3f);
  for (const int n : out.count) {
    if (n < 0 || (n > 0 && voxels > most / static_cast<unsigned>(n))) return wrong;
    voxels *= static_cast<unsigned>(n);
  }
  if (!in.ok() || in.remaining() != voxels * sizeof(Vec3f)) return wrong;
  const auto numbers = in.read_span(in.remaining());
  out.velocities.resize(voxels);
  if (voxels > 0) std::memcpy(static_cast<void*>(out.velocities.data()), numbers.data(), numbers.size());
  const bool finite =
      std::all_of(out.velocities.begin(), out.velocities.end(), [](const Vec3f& v) { return v.allFinite(); });
  if (!finite || !out.to_world.matrix().allFinite()) return wrong;
  return out;
}

}  // namespace ft::inline io

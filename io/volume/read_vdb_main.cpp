// followthrough_read_vdb FILE RESULT GRID MOST_VOXELS: started by read_vdb_velocity() under limits, not by people.
// Writes vdb_head() and the velocities, or in words why not.
#include <cstdio>
#include <cstdlib>

#include "baker/core/file.h"
#include "io/reading/reading_step.h"
#include "io/volume/openvdb_read.h"

namespace {

ft::Status write_result(const std::filesystem::path& path, const ft::VdbVelocity& velocity) {
  auto out = ft::OutputFile::create(path);
  if (!out) return out.error();
  const ft::Bytes head = ft::vdb_head(velocity);
  if (ft::Status s = out->write_at(0, head); !s) return s;
  if (ft::Status s = out->write_at(head.size(), std::as_bytes(std::span(velocity.velocities))); !s) return s;
  return out->close();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "%s is started by followthrough, to read .vdb files for it\n", argv[0]);
    return 64;
  }
  return ft::child_exit_code(argv[2], [&]() -> ft::Status {
    ft::reading_step("its grids, with OpenVDB");
    const auto velocity = ft::read_with_openvdb(argv[1], argv[3], std::atoll(argv[4]));
    if (!velocity) return velocity.error();
    return write_result(argv[2], *velocity);
  });
}

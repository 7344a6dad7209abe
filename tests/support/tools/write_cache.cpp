// A process of its own that writes a known cache, so that tests can make its writes fail or kill it.
//   write_cache PATH FRAMES KEEP
// The format is that of the extension; 10 frames are announced; each frame count is printed when it is durable.
// Exit code 0, or that of the error.
#include <cstdio>
#include <cstdlib>

#include "tests/support/cache_samples.h"

int main(int argc, char** argv) {
  using namespace ft;
  CHECK(argc == 4);
  const std::filesystem::path path = argv[1];
  const int frames = std::atoi(argv[2]), keep = std::atoi(argv[3]);
  test::CacheSample sample = test::waving_patch(3, 2, frames);
  sample.info.frame_count = 10;
  const CacheFormat* format = find_cache_format(path.extension().string().substr(1));
  CHECK(format != nullptr);
  const auto finish = [](const Status& status) {
    if (!status) std::fprintf(stderr, "%s\n", status.error().text().c_str());
    return status ? 0 : exit_code(status.error().kind);
  };
  auto writer = format->open_writer(path, sample.info, keep);
  if (!writer) return finish(writer.error());
  for (int f = keep; f < frames; ++f) {
    std::printf("%d\n", (*writer)->frame_count());
    std::fflush(stdout);
    const auto i = static_cast<std::size_t>(f);
    const Status status = (*writer)->write_frame(sample.positions[i], sample.velocities[i]);
    if (!status) return finish(status);
  }
  std::printf("%d\n", (*writer)->frame_count());
  return finish((*writer)->close());
}

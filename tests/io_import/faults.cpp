#include "tests/io_import/faults.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/support/assets.h"

namespace ft::test {

std::filesystem::path fault_folder(const std::string& name) {
  return assets_root() / "faults" / name;
}

ImportRequest fault_request(const std::string& name, const std::string& file) {
  std::map<std::string, std::string> values;  // of the shot and of its first primary: no key is in both
  std::ifstream in(fault_folder(name) / "shot.toml");
  std::string section;
  for (std::string line; std::getline(in, line) && section.rfind("[cloth", 0) != 0;) {
    if (line.rfind('[', 0) == 0) section = line;
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    std::string value = line.substr(equals + 3);
    value.erase(std::remove(value.begin(), value.end(), '"'), value.end());
    values.emplace(line.substr(0, equals), value);
  }
  const auto number = [&](const char* key, double otherwise) {
    return values.count(key) > 0 ? std::stod(values[key]) : otherwise;
  };
  ImportRequest request;
  request.file = fault_folder(name) / (file.empty() ? values["file"] : file);
  request.unit_scale = number("unit_scale", 0);
  request.shot_fps = number("fps", 24);
  int last = 1;
  std::sscanf(values["frames"].c_str(), "%d-%d", &request.first_frame, &last);
  request.duration = (last - request.first_frame) / request.shot_fps;
  request.preroll = number("preroll", 0) / request.shot_fps;
  return request;
}

std::map<int, Box> expected_boxes(const std::string& name) {
  std::ifstream in(fault_folder(name) / "expected.txt");
  std::map<int, Box> out;
  for (std::string line; std::getline(in, line);) {
    int frame = 0;
    Vec3 lo, hi;
    if (std::sscanf(line.c_str(), "frame %d: %lf %lf %lf .. %lf %lf %lf", &frame, &lo[0], &lo[1], &lo[2], &hi[0],
                    &hi[1], &hi[2]) == 7)
      out[frame] = Box{lo, hi};
  }
  return out;
}

double fault_error(const std::string& name, const ImportedPrimary& imported) {
  const ImportRequest request = fault_request(name);
  const auto boxes = expected_boxes(name);
  double worst = boxes.empty() ? std::numeric_limits<double>::infinity() : 0;
  std::vector<Vec3> positions(static_cast<std::size_t>(imported.trajectory->surface().vertex_count()));
  for (const auto& [frame, box] : boxes) {
    imported.trajectory->sample((frame - request.first_frame) / request.shot_fps, positions);
    const Box found = bounds(positions);
    worst = std::max({worst, (found.lo - box.lo).cwiseAbs().maxCoeff(), (found.hi - box.hi).cwiseAbs().maxCoeff()});
  }
  return worst;
}

}  // namespace ft::test

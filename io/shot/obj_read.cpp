// OBJ reader (Wavefront's "Advanced Visualizer" appendix B1): v, vt, f, g, o; the rest is skipped. One pass over the
// text, numbers by std::from_chars. Caution: faces may name vertices that come later, so indices are judged at the end.
// Sewing as the Codimensional IPC garments write it, which no standard knows: "seam N" opens a seam of N stitches,
// "stitch v a b t" sews vertex v to the point (1 - t) a + t b, "stitch v w" a vertex to a vertex. These count vertices
// from 0.
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "baker/core/file.h"
#include "io/shot/mesh_file.h"
#include "io/shot/obj_words.h"
#include "io/shot/vertex_colours.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_max_obj_bytes = std::uint64_t{1} << 30;
constexpr std::size_t k_shown_faults = 5;  ///< messages printed in full; the rest is counted

class ObjParser {
 public:
  explicit ObjParser(std::string_view where) : where_(where) {}

  void parse(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string joined;
    while (!text.empty()) {
      ++line_number_;
      std::string_view line = cut_line(text);
      if (continues(line)) {
        const int first = line_number_;
        joined.clear();
        while (continues(line)) {
          joined.append(line.substr(0, line.find_last_of('\\')));
          joined.push_back(' ');
          line = {};
          if (text.empty()) break;
          line = cut_line(text);
          ++continued_;
        }
        joined.append(line);
        parse_line(joined);
        line_number_ = first + continued_;
        continued_ = 0;
      } else {
        parse_line(line);
      }
    }
  }

  Result<Mesh> finish() {
    if (fault_count_ == 0 && mesh_.positions.empty())
      return input_error("holds no vertices; is it an OBJ file?", std::string(where_),
                         "garment meshes are Wavefront OBJ");
    judge_indices();
    if (fault_count_ > 0) return collected_faults();
    if (uv_corner_count_ != mesh_.face_vertices.size() || mesh_.face_vertices.empty()) {
      mesh_.uvs.clear();
      mesh_.face_uvs.clear();
    }
    finish_groups();
    const auto trim = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
    trim(mesh_.positions, mesh_.face_sizes, mesh_.face_vertices, mesh_.uvs, mesh_.face_uvs);
    return std::move(mesh_);
  }

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct FaceGroup {
    std::string name;
    std::vector<int> vertices;
  };

  static std::string_view cut_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
  }

  static bool continues(std::string_view line) {
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    return line.ends_with('\\');
  }

  void fault(std::string what) {
    if (++fault_count_ <= k_shown_faults) faults_.push_back(std::to_string(line_number_) + ": " + std::move(what));
  }

  void parse_line(std::string_view line) {
    const std::string_view key = next_word(line);
    if (key == "v")
      parse_vertex(line);
    else if (key == "f")
      parse_face(line);
    else if (key == "vt")
      parse_uv(line);
    else if (key == "g")
      parse_names(line, group_names_);
    else if (key == "o")
      parse_names(line, object_names_);
    else if (key == "seam")
      seam_open_ = true;
    else if (key == "stitch")
      parse_stitch(line);
  }

  void parse_stitch(std::string_view line) {
    Stitch stitch;
    line = line.substr(0, line.find('#'));
    std::vector<std::string_view> words;
    for (auto word = next_word(line); !word.empty() && words.size() < 5; word = next_word(line)) words.push_back(word);
    if (words.size() != 2 && words.size() != 4)
      return fault("stitch needs two vertices, or three and a place from 0 to 1 between the last two");
    int vertex[3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view word = words[words.size() == 2 ? std::min<std::size_t>(k, 1) : k];
      long long value = 0;
      if (!parse_index(word, value)) return fault("stitch has \"" + shown(word) + "\" for a vertex");
      if (value < 0 || value >= std::numeric_limits<int>::max())
        return fault("stitch names vertex " + shown(word) + ", which does not exist; they count from 0");
      vertex[k] = static_cast<int>(value);
    }
    stitch.vertex = vertex[0];
    stitch.edge = {vertex[1], vertex[2]};
    if (words.size() == 4 && (!parse_number(words[3], stitch.place) || !(stitch.place >= 0 && stitch.place <= 1)))
      return fault("stitch has \"" + shown(words[3]) + "\" for a place, which is from 0 to 1");
    // Stitches without a seam line are one seam.
    if (seam_open_ || seam_count_ == 0) ++seam_count_;
    seam_open_ = false;
    stitch.seam = seam_count_ - 1;
    mesh_.stitches.push_back(stitch);
    stitch_lines_.push_back(line_number_);
  }

  /// Up to 7 finite numbers of a line (a comment ends it); -1 after a fault.
  int parse_numbers(std::string_view line, double (&values)[8], const char* kind) {
    int count = 0;
    for (auto word = next_word(line); !word.empty() && word.front() != '#' && count < 8; word = next_word(line)) {
      double& value = values[count++];
      if (!parse_number(word, value))
        return fault(std::string(kind) + " has \"" + shown(word) + "\" for a number" + comma(word)), -1;
      if (!std::isfinite(value))
        return fault(std::string(kind) + " has the value " + shown(word) + ", which is not finite"), -1;
    }
    return count;
  }

  static std::string comma(std::string_view word) {
    return word.find(',') != std::string_view::npos ? " (decimal comma? OBJ uses points)" : "";
  }

  void parse_vertex(std::string_view line) {
    double x[8] = {};
    const int count = parse_numbers(line, x, "vertex");
    if (count >= 0 && count < 3) fault("vertex has " + std::to_string(count) + " coordinates, three are needed");
    mesh_.positions.emplace_back(x[0], x[1],
                                 x[2]);  // a faulty one keeps its number, so that later faults are not made up
    if (count == 6 || count == 7) {
      const int first = count == 6 ? 3 : 4;
      colours_.resize(mesh_.positions.size() - 1, Vec3::Zero());
      colours_.emplace_back(x[first], x[first + 1], x[first + 2]);
      const double largest = colours_.back().maxCoeff();
      if (largest > k_largest_colour)
        fault("vertex has a colour of " + number_text(largest) + "; colours are from 0 to 1, or from 0 to 255");
      largest_colour_ = std::max(largest_colour_, largest);
    }
  }

  void parse_uv(std::string_view line) {
    double x[8] = {};
    if (parse_numbers(line, x, "texture vertex") == 0) fault("texture vertex has no coordinates");
    mesh_.uvs.emplace_back(x[0], x[1]);
  }

  /// Index of `word` from 0; negative ones count back from the last element so far. -1 after a fault.
  int resolve(std::string_view word, std::size_t count_so_far, const char* kind) {
    long long index = 0;
    if (!parse_index(word, index)) return fault("face has \"" + shown(word) + "\" for a " + kind), -1;
    const long long resolved = index > 0 ? index - 1 : static_cast<long long>(count_so_far) + index;
    if (index == 0) return fault(std::string("face names ") + kind + " 0; they count from 1"), -1;
    if (resolved < 0 || resolved >= std::numeric_limits<int>::max())
      return fault(std::string("face names ") + kind + " " + shown(word) + ", which does not exist"), -1;
    return static_cast<int>(resolved);
  }

  void parse_face(std::string_view line) {
    const std::size_t begin = mesh_.face_vertices.size(), uv_begin = mesh_.face_uvs.size();
    bool good = true;
    for (auto word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line)) {
      const std::size_t slash = word.find('/');
      const int vertex = resolve(word.substr(0, slash), mesh_.positions.size(), "vertex");
      int uv = -1;
      if (slash != std::string_view::npos) {
        const std::string_view rest = word.substr(slash + 1);
        const std::string_view uv_word = rest.substr(0, rest.find('/'));
        if (!uv_word.empty()) uv = resolve(uv_word, mesh_.uvs.size(), "texture vertex"), good = good && uv >= 0;
      }
      good = good && vertex >= 0;
      mesh_.face_vertices.push_back(vertex);
      mesh_.face_uvs.push_back(uv);
    }
    const std::size_t size = mesh_.face_vertices.size() - begin;
    if (good && size < 3) fault("face has " + std::to_string(size) + " corners, three are needed"), good = false;
    if (!good) {
      mesh_.face_vertices.resize(begin);
      mesh_.face_uvs.resize(uv_begin);
      return;
    }
    for (std::size_t k = uv_begin; k < mesh_.face_uvs.size(); ++k) uv_corner_count_ += mesh_.face_uvs[k] >= 0 ? 1 : 0;
    mesh_.face_sizes.push_back(static_cast<int>(size));
    face_lines_.push_back(line_number_);
    for (const auto* names : {&group_names_, &object_names_})
      for (const std::size_t group : *names) {
        auto& vertices = groups_[group].vertices;
        vertices.insert(vertices.end(), mesh_.face_vertices.begin() + static_cast<std::ptrdiff_t>(begin),
                        mesh_.face_vertices.end());
      }
  }

  void parse_names(std::string_view line, std::vector<std::size_t>& current) {
    current.clear();
    for (auto word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line)) {
      const auto [place, added] = group_of_name_.try_emplace(std::string(word), groups_.size());
      if (added) groups_.push_back({std::string(word), {}});
      if (std::find(current.begin(), current.end(), place->second) == current.end()) current.push_back(place->second);
    }
  }

  void judge_indices() {
    const int vertex_count = mesh_.vertex_count(), uv_count = static_cast<int>(mesh_.uvs.size());
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh_.face_sizes.size(); ++f)
      for (int k = 0; k < mesh_.face_sizes[f]; ++k, ++corner) {
        line_number_ = face_lines_[f];
        const int v = mesh_.face_vertices[corner], uv = mesh_.face_uvs[corner];
        if (v >= vertex_count)
          fault("face names vertex " + std::to_string(v + 1) + " as OBJ counts, from 1; the file has " +
                std::to_string(vertex_count));
        if (uv >= uv_count)
          fault("face names texture vertex " + std::to_string(uv + 1) + " as OBJ counts, from 1; the file has " +
                std::to_string(uv_count));
      }
    for (std::size_t s = 0; s < mesh_.stitches.size(); ++s) {
      line_number_ = stitch_lines_[s];
      for (const int v : {mesh_.stitches[s].vertex, mesh_.stitches[s].edge[0], mesh_.stitches[s].edge[1]})
        if (v >= vertex_count)
          fault("stitch names vertex " + std::to_string(v) + ", the file has 0 to " + std::to_string(vertex_count - 1));
    }
  }

  Error collected_faults() const {
    std::string what = faults_.front();
    for (std::size_t i = 1; i < faults_.size(); ++i) what.append("\n").append(where_).append(":").append(faults_[i]);
    if (fault_count_ > faults_.size())
      what.append("\nand ").append(std::to_string(fault_count_ - faults_.size())).append(" more");
    // The line number belongs to the place: "dress.obj:12" "face has ...".
    const std::size_t colon = what.find(": ");
    return input_error(what.substr(colon + 2), std::string(where_).append(":").append(what, 0, colon),
                       "the file may be cut or damaged; export it again");
  }

  void finish_groups() {
    if (const std::string note = scale_colours(colours_, largest_colour_); !note.empty()) notes_.push_back(note);
    for (FaceGroup& group : groups_) {
      auto& v = group.vertices;
      std::sort(v.begin(), v.end());
      v.erase(std::unique(v.begin(), v.end()), v.end());
      if (v.empty()) continue;
      mesh_.groups.push_back({std::move(group.name), std::move(v), {}});
      mesh_.groups.back().weights.assign(mesh_.groups.back().vertices.size(), 1.0);
    }
    for (VertexGroup& group : groups_of_colours(colours_))
      if (!group_of_name_.contains(group.name))
        mesh_.groups.push_back(std::move(group));  // a face group of that name wins
  }

  std::string_view where_;
  Mesh mesh_;
  int line_number_ = 0, continued_ = 0;
  std::size_t uv_corner_count_ = 0, fault_count_ = 0;
  std::vector<std::string> faults_;
  std::vector<int> face_lines_, stitch_lines_;
  int seam_count_ = 0;
  bool seam_open_ = false;  ///< a seam line came, and no stitch of it yet
  std::vector<std::string> notes_;
  std::vector<Vec3> colours_;
  double largest_colour_ = 0;
  std::vector<FaceGroup> groups_;
  std::unordered_map<std::string, std::size_t> group_of_name_;  ///< looked up only, never walked
  std::vector<std::size_t> group_names_, object_names_;         ///< in force now
};

}  // namespace

Result<Mesh> parse_obj(std::string_view text, std::string_view where, std::vector<std::string>* notes) {
  // Every element costs at least four bytes of text; beyond this an int could overflow.
  if (text.size() > k_max_obj_bytes) return input_error("is larger than 1 GiB", std::string(where));
  ObjParser parser(where);
  parser.parse(text);
  auto mesh = parser.finish();
  if (mesh && notes) *notes = parser.notes();
  return mesh;
}

Result<Mesh> read_obj(const std::filesystem::path& path, std::vector<std::string>* notes) {
  const auto data = read_file(path, k_max_obj_bytes);
  if (!data) return data.error();
  const std::string_view text(reinterpret_cast<const char*>(data->data()), data->size());
  auto mesh = parse_obj(text, path.string(), notes);
  if (mesh) mesh->name = path.stem().string();
  return mesh;
}

}  // namespace ft::inline io

// "1001-1121" and "0-199, 250": the two small grammars inside the shot file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ft::inline io {

struct FrameRange {
  int first = 0, last = 0;
  bool operator==(const FrameRange&) const = default;
};

/// "1001-1121" or "1001", blanks allowed. False: `fault` says what is wrong and what was probably meant.
/// Negative frames are refused, because file names and "A-B" could not tell them apart; a run-up is what preroll is
/// for.
bool parse_frames(std::string_view text, FrameRange& range, std::string& fault);

/// "0-199, 250, 300-310"; ascending and unique in `out`. At most 20 million vertices.
bool parse_vertices(std::string_view text, std::vector<int>& out, std::string& fault);

/// "1001-1121" or "1001"; "0-199, 250".
std::string frames_text(const FrameRange& range);
std::string vertices_text(const std::vector<int>& ascending);

}  // namespace ft::inline io

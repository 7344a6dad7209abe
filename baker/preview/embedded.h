// Files that are part of the program: the preview's page, and three.js with its orbit controls (MIT, Debian's
// libjs-three). embedded.S includes their bytes.
#pragma once

#include <string_view>

namespace ft::inline baker {

std::string_view embedded_page();
std::string_view embedded_style();
std::string_view embedded_plots();
std::string_view embedded_paths();
std::string_view embedded_instances();
std::string_view embedded_curves();
std::string_view embedded_points();
std::string_view embedded_wind();
std::string_view embedded_water();
std::string_view embedded_player();
std::string_view embedded_three();
std::string_view embedded_controls();

}  // namespace ft::inline baker

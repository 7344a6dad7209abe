// The HTML page of compare: per pair a plot of largest and RMS difference over the frames, and the worst frame seen
// from the front and from the side, vertices coloured by how far they are from their twins. Plain SVG, no scripts,
// nothing loaded from elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/commands/compare_report.h"

namespace ft::inline baker {
namespace {

constexpr std::size_t k_most_points = 6000;  // per picture; above it every nth vertex, and all of the worst

constexpr const char* k_style =
    R"(body{font:14px/1.5 system-ui,sans-serif;margin:2em auto;max-width:64em;color:#222;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.2em;border-top:1px solid #ccc;padding-top:1em}
.verdict{color:#fff;padding:.1em .5em;border-radius:.3em}.equal{background:#2a7f3f}.different{background:#b3261e}.incomparable{background:#8a5a00}
svg{background:#fafafa;border:1px solid #ddd}table{border-collapse:collapse}td,th{padding:.1em .8em;text-align:right}
.files{color:#666;font-family:monospace;overflow-wrap:anywhere}text{font:11px system-ui,sans-serif;fill:#444}
figure{display:inline-block;margin:0 1em 1em 0}figcaption{color:#666})";

/// Dark violet over red to yellow, t in [0, 1].
std::string heat(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const double red = std::min(1.0, 0.25 + 1.5 * t), green = t < 0.4 ? 0.12 * t / 0.4 : 0.12 + 0.75 * (t - 0.4) / 0.6;
  const double blue = t < 0.4 ? 0.45 * (1 - t / 0.4) + 0.1 : 0.1;
  const auto byte = [](double x) { return static_cast<int>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(red), byte(green), byte(blue));
}

/// Largest (dark) and RMS (light) difference over the frames, logarithmic: differences grow over decades.
std::string plot(const CompareReport& r) {
  constexpr double k_width = 900, k_height = 240, k_left = 70, k_right = 12, k_top = 12, k_bottom = 28;
  double largest = r.tolerance, smallest = r.tolerance > 0 ? r.tolerance : 1e300;
  for (const FrameDifference& f : r.frames)
    for (const double x : {f.max, f.rms})
      if (x > 0) largest = std::max(largest, x), smallest = std::min(smallest, x);
  if (largest <= 0 || r.frames.empty()) return "<p>No vertex differs in any frame.</p>";
  const double top = std::ceil(std::log10(largest)),
               bottom = std::min(top - 1, std::max(std::floor(std::log10(smallest)), top - 10));
  const double frames = std::max<double>(1, static_cast<double>(r.frames.size()) - 1);
  const auto place_x = [&](double i) { return k_left + (k_width - k_left - k_right) * i / frames; };
  const auto place_y = [&](double value) {
    const double level = value > 0 ? std::clamp((std::log10(value) - bottom) / (top - bottom), 0.0, 1.0) : 0;
    return k_height - k_bottom - (k_height - k_top - k_bottom) * level;
  };
  std::string svg = fmt::format("<svg width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">", k_width, k_height);
  for (double decade = bottom; decade <= top; ++decade) {
    const double y = place_y(std::pow(10, decade));
    svg += fmt::format("<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>", k_left,
                       k_width - k_right, y, y);
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g} mm</text>", k_left - 6, y + 4,
                       std::pow(10, decade + 3));
  }
  if (r.tolerance > 0) {
    const double y = place_y(r.tolerance);
    svg += fmt::format(
        "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#2a7f3f\" stroke-dasharray=\"5 4\"/>", k_left,
        k_width - k_right, y, y);
    svg +=
        fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">tolerance</text>", k_width - k_right - 4, y - 4);
  }
  for (const bool rms : {true, false}) {
    std::string line;
    for (std::size_t i = 0; i < r.frames.size(); ++i)
      line += fmt::format("{:.1f},{:.1f} ", place_x(static_cast<double>(i)),
                          place_y(rms ? r.frames[i].rms : r.frames[i].max));
    svg += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"{}\"/>",
                       rms ? "#e0a070" : "#b3261e", line);
  }
  if (r.first_diverging >= 0) {
    const double x = place_x(r.first_diverging);
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#b3261e\" stroke-dasharray=\"2 3\"/>", x,
        k_top, k_height - k_bottom);
  }
  svg += fmt::format("<text x=\"{}\" y=\"{}\">frame {}</text>", k_left, k_height - 8, r.frames.front().frame);
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text></svg>", k_width - k_right, k_height - 8,
                     r.frames.back().frame);
  return "<figure>" + svg +
         "<figcaption>Largest (red) and RMS (sand) distance of vertices from their twins, per "
         "frame.</figcaption></figure>";
}

/// Vertices to draw, least distant first, so that the worst are on top.
std::vector<std::size_t> vertices_to_draw(const CompareReport& r) {
  std::vector<std::size_t> order(r.picture_positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return r.picture_distances[a] < r.picture_distances[b]; });
  if (order.size() <= k_most_points) return order;
  const std::size_t worst = k_most_points / 3, rest = order.size() - worst;
  const std::size_t step = (rest + k_most_points - worst - 1) / (k_most_points - worst);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < rest; i += step) out.push_back(order[i]);
  out.insert(out.end(), order.end() - static_cast<std::ptrdiff_t>(worst), order.end());
  return out;
}

/// Orthographic view along an axis; y is up.
std::string view(const CompareReport& r, const std::vector<std::size_t>& order, int across, double direction,
                 const char* caption) {
  constexpr double k_size = 430, k_margin = 14;
  Eigen::Vector2d lo = Eigen::Vector2d::Constant(1e300), hi = -lo;
  const auto flat = [&](const Vec3f& p) { return Eigen::Vector2d(direction * p[across], p[1]); };
  for (const Vec3f& p : r.picture_positions) lo = lo.cwiseMin(flat(p)), hi = hi.cwiseMax(flat(p));
  const double extent = std::max({(hi - lo).maxCoeff(), 1e-9}), scale = (k_size - 2 * k_margin) / extent;
  const Eigen::Vector2d centre = (lo + hi) / 2;
  const double most =
      std::max<double>(*std::max_element(r.picture_distances.begin(), r.picture_distances.end()), 1e-30);
  std::string svg = fmt::format("<svg width=\"{0}\" height=\"{0}\" viewBox=\"0 0 {0} {0}\">", k_size);
  const auto place = [&](std::size_t i) {
    const Eigen::Vector2d p = (flat(r.picture_positions[i]) - centre) * scale;
    return Eigen::Vector2d(k_size / 2 + p.x(), k_size / 2 - p.y());
  };
  const double radius = std::clamp(75 / std::sqrt(static_cast<double>(order.size())), 1.5, 4.0);
  for (const std::size_t i : order) {
    const Eigen::Vector2d p = place(i);
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>", p.x(), p.y(), radius,
                       heat(r.picture_distances[i] / most));
  }
  if (r.worst >= 0) {
    const Eigen::Vector2d p = place(order.back());
    svg +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.5\"/>",
                    p.x(), p.y());
  }
  return "<figure>" + svg + "</svg><figcaption>" + caption + "</figcaption></figure>";
}

std::string pictures(const CompareReport& r) {
  if (r.picture_positions.empty()) return {};
  const auto order = vertices_to_draw(r);
  const FrameDifference& f = r.frames[r.worst >= 0 ? static_cast<std::size_t>(r.worst) : r.frames.size() - 1];
  std::string text =
      r.worst >= 0
          ? fmt::format("<p>Frame {}: dark vertices agree, yellow ones are {} off, the worst ({}) is circled.</p>",
                        f.frame, length_text(f.max), r.element(f.vertex))
          : fmt::format("<p>Frame {}.</p>", f.frame);
  return text + view(r, order, 0, 1, "from the front (x to the right, y up)") +
         view(r, order, 2, -1, "from the right (z to the left, y up)");
}

}  // namespace

std::string compare_html(const std::vector<CompareReport>& reports) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Comparison of caches</title>\n<style>";
  out += std::string(k_style) + "</style></head><body>\n<h1>Comparison of caches</h1>\n";
  for (const CompareReport& r : reports) {
    out += fmt::format("<h2>{0} <span class=\"verdict {1}\">{1}</span></h2>\n<p>{2}.</p>\n", escaped(r.system),
                       verdict_name(r.verdict), escaped(summary(r)));
    out += fmt::format("<p class=\"files\">a: {}<br>b: {}</p>\n", escaped(r.a), escaped(r.b));
    if (r.verdict == CompareVerdict::k_incomparable) continue;
    out += plot(r) + "\n" + pictures(r) + "\n";
  }
  return out + "</body></html>\n";
}

}  // namespace ft::inline baker

#include "baker/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>

#include "baker/record/report_json.h"

namespace ft::inline baker {
namespace {

class TextProgress : public Progress {
 public:
  explicit TextProgress(std::FILE* out) : out_(out) {}

 protected:
  void line(const std::string& text) {
    std::fputs((text + "\n").c_str(), out_);
    std::fflush(out_);
  }
  void lines(const std::vector<std::string>& all) {
    for (const std::string& text : all) line(text);
  }
  std::FILE* out_;
};

std::string opening(const ProgressStart& s) {
  const std::string resumed = s.from_frame > s.first_frame - s.preroll + 1
                                  ? fmt::format(", resuming at frame {}", s.from_frame)
                                  : std::string();
  std::string what = s.instance_count > 0 ? fmt::format("{} instances", s.instance_count) : std::string();
  if (s.vertex_count > 0 || what.empty())
    what = fmt::format("{} vertices{}{}", s.vertex_count, what.empty() ? "" : ", ", what);
  return fmt::format("baking {}: frames {}-{} after {} of pre-roll, {}, {} threads{}", s.shot, s.first_frame,
                     s.last_frame, s.preroll, what, s.threads, resumed);
}

double percent(const ProgressFrame& f) {
  return f.total > 0 ? 100.0 * f.done / f.total : 100.0;
}

class Plain final : public TextProgress {
 public:
  using TextProgress::TextProgress;
  void begin(const ProgressStart& s) override { line(opening(s)); }
  void note(const std::string& text) override { line("note: " + text); }
  void frame(const ProgressFrame& f) override {
    line(fmt::format("frame {}{}  {}/{}  {:.0f} ms  {} left  strain p99 {:.2f} %  {}", f.report.frame,
                     f.preroll ? " (pre-roll)" : "", f.done, f.total, 1e3 * f.seconds, clock_text(f.seconds_left),
                     100 * f.report.strain_p99, health(f.report)));
  }
  void end(const ProgressEnd& e) override {
    line(fmt::format("{} ({})", e.text, clock_text(e.seconds)));
    lines(e.details);
  }
};

class Bar final : public TextProgress {
 public:
  using TextProgress::TextProgress;
  void begin(const ProgressStart& s) override { line(opening(s)); }
  void note(const std::string& text) override {
    clear();
    line("note: " + text);
    redraw();
  }
  void frame(const ProgressFrame& f) override {
    constexpr int k_width = 30;
    const int full = static_cast<int>(std::lround(percent(f) / 100 * k_width));
    std::string bar;
    for (int i = 0; i < k_width; ++i) bar += i < full ? "█" : "░";
    const std::string state = health(f.report);
    if (state != "ok") ++troubled_;
    shown_ = fmt::format("{} {:3.0f} %  frame {}{}  {} left  {:.0f} ms  {}", bar, percent(f), f.report.frame,
                         f.preroll ? " pre-roll" : "", clock_text(f.seconds_left), 1e3 * f.seconds, state);
    if (troubled_ > 0 && state == "ok") shown_ += fmt::format(" ({} frames to look at)", troubled_);
    redraw();
  }
  void end(const ProgressEnd& e) override {
    clear();
    line(fmt::format("{} ({})", e.text, clock_text(e.seconds)));
    lines(e.details);
  }

 private:
  void clear() { std::fputs("\r\x1b[K", out_); }
  void redraw() {
    std::fputs(("\r\x1b[K" + shown_).c_str(), out_);
    std::fflush(out_);
  }
  std::string shown_;
  int troubled_ = 0;
};

class Tractor final : public TextProgress {
 public:
  using TextProgress::TextProgress;
  void note(const std::string& text) override { line("note: " + text); }
  void frame(const ProgressFrame& f) override {
    line(fmt::format("TR_PROGRESS {:03d}%", static_cast<int>(percent(f))));
  }
  void end(const ProgressEnd& e) override {
    line(e.text);
    lines(e.details);
  }
};

class Deadline final : public TextProgress {
 public:
  using TextProgress::TextProgress;
  void note(const std::string& text) override { line("note: " + text); }
  void frame(const ProgressFrame& f) override { line(fmt::format("Progress: {}%", static_cast<int>(percent(f)))); }
  void end(const ProgressEnd& e) override {
    line(e.exit_code == 0 ? e.text : "Error: " + e.text);
    lines(e.details);
  }
};

class OpenJd final : public TextProgress {
 public:
  using TextProgress::TextProgress;
  void begin(const ProgressStart& s) override { line("openjd_status: " + opening(s)); }
  void note(const std::string& text) override { line("note: " + text); }
  void frame(const ProgressFrame& f) override {
    line(fmt::format("openjd_progress: {:.1f}", percent(f)));
    line(fmt::format("openjd_status: frame {}, {} left, {}", f.report.frame, clock_text(f.seconds_left),
                     health(f.report)));
  }
  void end(const ProgressEnd& e) override {
    line((e.exit_code == 0 ? "openjd_status: " : "openjd_fail: ") + e.text);
    lines(e.details);
  }
};

/// Progress mode json and the log file: the same objects; the log adds the time of day.
class JsonLines final : public TextProgress {
 public:
  JsonLines(std::FILE* out, bool owns, bool with_time) : TextProgress(out), owns_(owns), with_time_(with_time) {}
  JsonLines(const JsonLines&) = delete;
  JsonLines& operator=(const JsonLines&) = delete;
  ~JsonLines() override {
    if (owns_) std::fclose(out_);
  }
  void begin(const ProgressStart& s) override {
    write("begin", {{"shot", s.shot},
                    {"folder", s.folder},
                    {"first", s.first_frame},
                    {"last", s.last_frame},
                    {"preroll", s.preroll},
                    {"from", s.from_frame},
                    {"vertices", s.vertex_count},
                    {"instances", s.instance_count},
                    {"threads", s.threads}});
  }
  void note(const std::string& text) override { write("note", {{"text", text}}); }
  void frame(const ProgressFrame& f) override {
    write("frame", {{"done", f.done},
                    {"total", f.total},
                    {"percent", percent(f)},
                    {"is_preroll", f.preroll},
                    {"seconds", f.seconds},
                    {"seconds_left", f.seconds_left},
                    {"health", health(f.report)},
                    {"report", to_json(f.report)},
                    {"profile", to_json(f.report.profile)}});
  }
  void end(const ProgressEnd& e) override {
    write("end", {{"exit_code", e.exit_code}, {"text", e.text}, {"seconds", e.seconds}, {"details", e.details}});
  }

 private:
  void write(const char* event, Json fields) {
    Json out{{"event", event}};
    if (with_time_) {
      const std::time_t now = std::time(nullptr);
      std::tm parts{};
      std::array<char, 32> text{};
      std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &parts));
      out["time"] = text.data();
    }
    out.update(fields);
    line(out.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  bool owns_, with_time_;
};

class Combined final : public Progress {
 public:
  explicit Combined(std::vector<std::unique_ptr<Progress>> all) : all_(std::move(all)) {}
  void begin(const ProgressStart& s) override {
    for (auto& p : all_) p->begin(s);
  }
  void note(const std::string& t) override {
    for (auto& p : all_) p->note(t);
  }
  void frame(const ProgressFrame& f) override {
    for (auto& p : all_) p->frame(f);
  }
  void end(const ProgressEnd& e) override {
    for (auto& p : all_) p->end(e);
  }

 private:
  std::vector<std::unique_ptr<Progress>> all_;
};

struct Mode {
  std::string_view name;
  std::unique_ptr<Progress> (*make)(std::FILE*);
};

template <class T>
std::unique_ptr<Progress> make(std::FILE* out) {
  return std::make_unique<T>(out);
}

constexpr std::array<Mode, 7> k_modes = {{
    {"bar", make<Bar>},
    {"plain", make<Plain>},
    {"json",
     [](std::FILE* out) -> std::unique_ptr<Progress> { return std::make_unique<JsonLines>(out, false, false); }},
    {"tractor", make<Tractor>},
    {"deadline", make<Deadline>},
    {"openjd", make<OpenJd>},
    {"none", [](std::FILE*) -> std::unique_ptr<Progress> { return std::make_unique<Progress>(); }},
}};

}  // namespace

std::vector<std::string_view> progress_modes() {
  std::vector<std::string_view> out;
  for (const Mode& mode : k_modes) out.push_back(mode.name);
  return out;
}

Result<std::unique_ptr<Progress>> make_progress(std::string_view mode, std::FILE* out) {
  if (mode.empty()) mode = ::isatty(::fileno(out)) ? "bar" : "plain";
  std::string known;
  for (const Mode& m : k_modes) {
    if (m.name == mode) return m.make(out);
    known += (known.empty() ? "" : ", ") + std::string(m.name);
  }
  return usage_error("unknown progress mode \"" + std::string(mode) + "\"", "--progress", "there are: " + known);
}

Result<std::unique_ptr<Progress>> make_json_log(const std::filesystem::path& file) {
  std::FILE* out = std::fopen(file.c_str(), "we");
  if (!out) return output_error("the log cannot be written", file.string(), "choose another file with --log-json");
  return std::unique_ptr<Progress>(std::make_unique<JsonLines>(out, true, true));
}

std::unique_ptr<Progress> combine(std::vector<std::unique_ptr<Progress>> all) {
  return std::make_unique<Combined>(std::move(all));
}

std::string health(const FrameReport& r) {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (!r.finite) add("no finite step");
  if (r.crossings_body > 0) add(fmt::format("{} crossings with the body", r.crossings_body));
  if (r.crossings_self > 0) add(fmt::format("{} among cloths", r.crossings_self));
  if (r.inside_body > 0) add(fmt::format("{} vertices inside the body", r.inside_body));
  if (r.open_stitches > 0) add(fmt::format("seams open by up to {:.1f} mm", 1e3 * r.widest_seam));
  if (r.released_vertices > 0)
    add(fmt::format("{} vertices of the collider or points of cords let go for lack of room", r.released_vertices));
  if (std::any_of(r.incidents.begin(), r.incidents.end(),
                  [](const Incident& i) { return i.kind == Incident::Kind::k_cut_short; }))
    add("cut short");
  return out.empty() ? "ok" : out;
}

std::string clock_text(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return "?";
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long all = std::lround(seconds);
  if (all < 60) return fmt::format("{} s", all);
  if (all < 3600) return fmt::format("{}:{:02d}", all / 60, all % 60);
  return fmt::format("{}:{:02d}:{:02d}", all / 3600, all / 60 % 60, all % 60);
}

}  // namespace ft::inline baker

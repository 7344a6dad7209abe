#include "baker/run/profile_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace ft::inline baker {

struct ProfileText::Sums {
  FrameProfile sum;
  double total = 0;  ///< with what the conductor does around the solver [s]
  std::vector<double> seconds;
  long substeps = 0, newton = 0, linear = 0;
};

namespace {

class Listener final : public Progress {
 public:
  explicit Listener(std::function<void(const ProgressFrame&)> hear) : hear_(std::move(hear)) {}
  void frame(const ProgressFrame& f) override { hear_(f); }

 private:
  std::function<void(const ProgressFrame&)> hear_;
};

}  // namespace

ProfileText::ProfileText() : sums_(std::make_shared<Sums>()) {}

std::unique_ptr<Progress> ProfileText::listener() {
  return std::make_unique<Listener>([sums = sums_](const ProgressFrame& f) {
    sums->sum += f.report.profile;
    sums->total += f.seconds;
    sums->seconds.push_back(f.seconds);
    sums->substeps += f.report.substeps;
    sums->newton += f.report.newton_iterations;
    sums->linear += f.report.linear_iterations;
  });
}

std::vector<std::string> ProfileText::lines() const {
  std::vector<std::string> out;
  if (sums_->seconds.empty()) return out;
  const double total = sums_->total, count = static_cast<double>(sums_->seconds.size());
  auto sorted = sums_->seconds;
  std::sort(sorted.begin(), sorted.end());
  out.push_back(fmt::format("{} frames in {}: mean {:.1f} ms, median {:.1f} ms, slowest {:.1f} ms", sorted.size(),
                            clock_text(total), 1e3 * total / count, 1e3 * sorted[sorted.size() / 2],
                            1e3 * sorted.back()));
  out.push_back(fmt::format("a frame: {:.1f} substeps, {:.1f} Newton steps, {:.1f} CG iterations",
                            static_cast<double>(sums_->substeps) / count, static_cast<double>(sums_->newton) / count,
                            static_cast<double>(sums_->linear) / count));
  double known = 0;
  const auto row = [&](const char* name, double seconds) {
    out.push_back(
        fmt::format("  {:<16} {:8.1f} ms a frame {:5.1f} %", name, 1e3 * seconds / count, 100 * seconds / total));
  };
  for (const ProfilePhase& phase : profile_phases())
    row(phase.title, sums_->sum.*phase.time), known += sums_->sum.*phase.time;
  row("other", std::max(0.0, total - known));
  return out;
}

}  // namespace ft::inline baker

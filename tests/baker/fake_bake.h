// A bake without import and without physics, for everything that the conductor does around them: a box as primary, a
// sheet whose next position depends on its last one (so that a resume from the wrong state shows), and services that
// misbehave on demand.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "baker/record/bake_folder.h"
#include "baker/run/bake.h"
#include "baker/systems/cloth/cloth_group.h"
#include "baker/systems/cords/cords_group.h"
#include "tests/support/assets.h"

namespace ft::test {

struct FakeBehaviour {
  std::function<void(int frame)> on_frame{};                           ///< called before each frame is solved
  std::function<void(int frame, FrameReport&, State&)> after_frame{};  ///< may spoil the answer
  /// Called with the bobbing box and the request; its motion is the primary's then.
  std::function<std::unique_ptr<Trajectory>(const Trajectory& box, const ImportRequest& request)> move{};
  bool absent = false;  ///< no garment meets the box
};

/// What the shot of a FakeScene has beside its sheet.
enum class Beside { k_nothing, k_swarm, k_tress };

/// 3 x 3 x 3 sheet beside a box of 1 m; groups "top" (3 vertices) and "none" (weights 0).
class FakeScene {
 public:
  /// A swarm flies about the box (swarm_kind.h), or a tress swings beside it (tress_kind.h); their kind is there for as
  /// long as the scene is.
  explicit FakeScene(Beside beside = Beside::k_nothing);

  /// frames "1-N"; extra: lines of TOML at the end.
  void write_shot(int last_frame = 10, const std::string& cloth_lines = "", const std::string& extra = "");
  void write_garment(const Mesh& mesh);
  static Mesh sheet();

  BakeOptions options() const;
  BakeServices services(FakeBehaviour behaviour = {}) const;
  BakeResult run(const BakeOptions& options, FakeBehaviour behaviour = {}) const;
  BakeResult run() const { return run(options()); }

  std::filesystem::path file(const std::string& name) const { return scratch_ / name; }
  BakeFolder folder() const { return {scratch_ / "out"}; }
  /// Name -> content hash of everything that a user takes: caches, OBJ, manifest; not report.json, not .state.
  std::map<std::string, std::string> products(const std::filesystem::path& folder) const;
  std::map<std::string, std::string> products() const { return products(folder().path); }
  std::string manifest_text() const;

 private:
  ScratchFolder scratch_;
  Beside beside_;
  std::optional<AddedSystemKind> kind_;
};

/// All faults in one string.
std::string text(const BakeResult& result);

/// Remembers what it was told; sends itself a signal after a frame if asked to.
class RecordedProgress : public Progress {
 public:
  void begin(const ProgressStart& s) override { start = s; }
  void note(const std::string& t) override { notes += t + "\n"; }
  void frame(const ProgressFrame& f) override {
    frames.push_back(f.report.frame);
    if (on_frame) on_frame(f.report.frame);
  }
  void end(const ProgressEnd& e) override { last = e; }

  ProgressStart start;
  std::string notes;
  std::vector<int> frames;
  ProgressEnd last;
  std::function<void(int)> on_frame;
};

/// The plan of folder/shot.toml, which reads no primary from a file.
Result<BakePlan> plan_shot_in(const std::filesystem::path& folder);
/// A bake of folder/shot.toml, which reads no primary from a file, into folder/name. interrupted_after: frames, by
/// SIGINT.
BakeResult bake_shot_in(const std::filesystem::path& folder, const std::string& name, int threads = 1,
                        int interrupted_after = 0, bool resume = false);
/// Bakes it into folder/one with one thread, and beside that with two and with an interruption after so many frames.
void expect_threads_and_interruptions_change_no_byte(const std::filesystem::path& folder, int interrupted_after);

/// A bake of a scene in which systems of other shapes than meshes are written and judged.
class ShapesBakeTest : public testing::Test {
 protected:
  ShapesBakeTest(Beside beside, std::string system) : scene_(beside), system_(std::move(system)) {}

  /// Into a folder of its own, with other settings.
  std::filesystem::path bake_with(const std::string& name, const std::vector<std::string>& overrides) const;
  /// Says something else of the system in the manifest.
  void falsify(const std::function<void(ManifestSystem&)>& change) const;
  /// What check refuses.
  std::string judged() const;

  const FakeScene scene_;

 private:
  std::string system_;
};

}  // namespace ft::test

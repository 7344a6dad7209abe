// Which of the collider's vertices a garment does not meet, because there is no room for it. A feature (vertex, edge,
// triangle) of the collider is absent for a garment where one of its vertices is.
//
//   planned    the body is too deep in itself there (collision/body/absent_vertices.h), or the shot has it ignored
//   let go     cloth was blocked on all sides (Candidates::release_blocked), or what was planned is over but the cloth
//              is still on the wrong side or crosses it. A hole that has to grow does so by its half, lest a place
//              without room is found vertex by vertex. A part that a garment does not wear (a hand, for a skirt) and
//              that it has got through goes as a whole, with all that hangs on it: half a hand is a hook. So does one
//              in which cloth is caught, which would drag it along and stretch it.
//
// What was let go comes back at the end of a frame, where no cloth crosses it, is inside or all but touches it. Until
// then cloth that it lay on is drawn back there (draw_back.h), and other cloth inside is pushed out. What is absent for
// a garment drags nothing of it along.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/check/checked_surface.h"
#include "collision/check/crossings.h"
#include "solvers/cloth/model/cloth_motion.h"

namespace ft::inline solvers {

struct ClothModel;

/// What becomes of a vertex of the cloth in a substep, see draw_back.h.
struct SkinHold {
  int vertex = 0;
  bool to_skin = false;        ///< it is drawn back to Absence::place_on_skin()
  Vec3 place = Vec3::Zero();   ///< else: it stays above the plane through this [m]
  Vec3 normal = Vec3::Zero();  ///< of the plane
  /// Of the collider, of a part that the garment wears: inside of it the cloth goes along with this and moves against
  /// it slowly; -1: it does not.
  int along = -1;
};

/// What never changes of a body's absence: of each garment and each of the collider's vertices or parts.
class Absence {
 public:
  Absence() = default;
  /// Of a model with its collider in place.
  explicit Absence(const ClothModel& model);

  std::size_t body_count() const { return body_count_; }
  /// Where ClothMotion::absent has a vertex of the collider.
  std::size_t place(int garment, int body_vertex) const {
    return static_cast<std::size_t>(garment) * body_count_ + static_cast<std::size_t>(body_vertex);
  }
  /// What is absent at the start.
  std::vector<char> at_start(std::span<const char> deep) const;
  /// Takes out what is too deep at either end of a substep (per vertex of the collider).
  void take_out(std::span<const char> deep_t0, std::span<const char> deep_t1, std::vector<char>& absent) const;
  /// Lets go of these vertices of the collider for a garment, and of what is around them; returns how many are new.
  /// Of parts that the garment does not wear, and of smaller ones, it is all that is near, else what is next to them: a
  /// hole in what a sleeve lies on swallows it. But a hole that has to grow does so by its half at least: a place
  /// without room is found by a few searches then. deep: at the end of the substep.
  int let_go(const ClothModel& model, int garment, std::span<const int> body_vertices, std::span<const Vec3> body,
             std::span<const char> deep, std::vector<char>& absent) const;
  /// All of the collider; returns how many are new.
  int let_go_of_all(int garment, std::vector<char>& absent) const;
  /// At the end of a frame: what is clear of a garment comes back, what it has got through goes. crossings: of the
  /// cloth (first) with the collider, absent or not.
  void bring_back(const ClothModel& model, std::span<const Crossing> crossings, const CheckedSurface& collider,
                  std::span<const char> deep, ClothMotion& motion) const;
  /// At the end of a frame, after bring_back(): a part that a garment does not wear and that has caught it, so that the
  /// cloth on it is stretched far beyond what clothes bear, goes as a whole with all that hangs on it.
  void let_go_of_what_caught(const ClothModel& model, const CheckedSurface& collider, ClothMotion& motion) const;
  /// Of a garment's vertices that are let go, how many, and one of them, or -1.
  struct LetGo {
    int count = 0, vertex = -1;
  };
  LetGo let_go_now(int garment, std::span<const char> deep, std::span<const char> absent) const;
  /// What becomes of cloth in and around what is let go. body: of the collider [m].
  std::vector<SkinHold> skin_holds(const ClothModel& model, std::span<const Vec3> body, std::span<const char> deep,
                                   const ClothMotion& motion) const;
  /// Where a vertex of the cloth lay on the collider in the bind pose, as that is now [m].
  Vec3 place_on_skin(int vertex, std::span<const Vec3> body) const;

  /// Whether an element of the collider (vertices from 0) is absent for the garment.
  template <class Vertices>
  bool is_absent(std::span<const char> absent, int garment, const Vertices& vertices) const {
    for (const int v : vertices)
      if (absent[place(garment, v)] != 0) return true;
    return false;
  }
  bool is_absent(const ClothModel& model, const Crossing& crossing, std::span<const char> absent) const;

 private:
  bool planned(int garment, int body_vertex, std::span<const char> deep) const {
    return deep[static_cast<std::size_t>(body_vertex)] != 0 || ignored_[place(garment, body_vertex)] != 0;
  }
  /// Whether a part goes as a whole, where a garment has got through it or is caught in it: a limb that the garment
  /// does not wear. A set that stands still never does, nor does a sheet.
  bool goes_whole(int garment, int part) const {
    return worn_[static_cast<std::size_t>(garment)][static_cast<std::size_t>(part)] == 0 &&
           stays_[static_cast<std::size_t>(part)] == 0;
  }
  /// Where a vertex of the cloth lay on the collider in the bind pose.
  struct Anchor {
    Triangle triangle{-1, -1, -1};  ///< -1: it did not lie on it
    float weight[3] = {0, 0, 0};
    float height = 0;  ///< along the triangle's normal [m]; below 0 on the other side of a sheet
  };
  std::optional<TriangleTree> tree_of_solids(const ClothModel& model, std::span<const Vec3> body) const;
  /// Adds all parts that hang on parts that are gone.
  void add_descendants(std::vector<char>& gone) const;
  void grow(const ClothModel& model, std::span<const Vec3> body, double reach, int least_rank,
            std::vector<char>& marked) const;
  void widen(int garment, std::span<const int> parts, std::span<const char> deep, std::span<const char> absent,
             std::vector<char>& marked) const;

  std::size_t body_count_ = 0;
  std::vector<char> ignored_;            ///< as ClothMotion::absent
  std::vector<std::vector<char>> worn_;  ///< per garment and part
  std::vector<int> parents_;             ///< per part
  std::vector<char> stays_, sheet_;      ///< per part: it never goes as a whole; SurfacePart::sheet
  Adjacency neighbours_;                 ///< of the collider's vertices
  TriangleTree tree_;                    ///< of the collider in its bind pose
  std::vector<Anchor> anchors_;          ///< per vertex of the cloth
};

}  // namespace ft::inline solvers

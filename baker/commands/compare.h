// compare: are two caches, or the caches of two bake folders, the same within a tolerance? For regression suites and
// for artists who changed "nothing". Meshes, instances (compare_instances.h), curves (compare_curves.h), points
// (compare_points.h). Any two
// formats: what only one of them holds (topology, frame rate, velocities) is not compared. compare_caches is pure:
// readers in, report out; compare_report.h turns reports into text, JSON, HTML and JUnit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "baker/commands/compare_curves.h"
#include "baker/commands/compare_instances.h"
#include "baker/commands/compare_points.h"
#include "baker/commands/compare_scalars.h"
#include "baker/core/result.h"
#include "baker/core/types.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

struct CompareOptions {
  std::filesystem::path a, b;               ///< two caches or two folders with caches
  double tolerance = 0;                     ///< m, >= 0: distance of a vertex from its twin that still counts as equal;
                                            ///< the same number of scales and of scalars of vertices
  std::filesystem::path json, html, junit;  ///< reports to write; empty: none
  double degrees = 0;                       ///< >= 0: rotation of an instance that still counts as equal
};

enum class CompareVerdict {
  k_equal,      ///< exit code 0
  k_different,  ///< 1: same topology and range, a vertex beyond the tolerance; instances, strands or points that only
                ///< one has
  k_incomparable,  ///< 3: another topology or frame range, or unreadable
};

struct FrameDifference {
  int frame = 0;
  double max = 0, rms = 0;  ///< over the vertices [m]
  int vertex = -1;          ///< where max is; -1: all are bit-equal
  double max_speed = 0;     ///< largest difference of velocities [m/s]; 0 where one cache has none
  int speed_vertex = -1;
  // Of instances; vertex and speed_vertex are then indices into InstanceDifference::ids.
  double turn = 0;  ///< largest angle between orientations [degrees]
  int turn_vertex = -1;
  double spin = 0;   ///< largest difference of angular velocities [degrees/s]
  double scale = 0;  ///< largest difference of scales [1]
  // Of meshes with scalars of vertices.
  double scalar = 0;                         ///< largest difference of one [1]
  int scalar_vertex = -1, scalar_index = 0;  ///< where, and of which in ScalarsDifference::both
};

struct CompareReport {
  std::string system;  ///< name of the garment
  std::string a, b;    ///< the files, as given
  CompareVerdict verdict = CompareVerdict::k_equal;
  std::string reason;          ///< of k_incomparable, in one sentence
  double tolerance = 0;        ///< m
  double speed_tolerance = 0;  ///< m/s: the tolerance within one frame
  double turn_tolerance = 0;   ///< degrees
  double spin_tolerance = 0;   ///< degrees/s: the tolerance within one frame
  int vertex_count = 0, first_frame = 0;
  bool velocities = false;  ///< both have them
  std::vector<FrameDifference> frames;
  int first_diverging = -1;  ///< index into frames of the first one beyond the tolerance, -1: none
  int worst = -1;            ///< index into frames of the largest difference of positions, -1: no difference at all
  double rms = 0;            ///< over all frames and vertices [m]
  // The picture of where: vertices of b in the worst frame (the last one where nothing differs), and how far each is
  // from a.
  std::vector<Vec3f> picture_positions;
  std::vector<float> picture_distances;           ///< m
  std::optional<InstanceDifference> instances{};  ///< of caches of instances
  std::optional<CurveDifference> curves{};        ///< of caches of curves
  std::optional<PointDifference> points{};        ///< of caches of points
  ScalarsDifference scalars{};                    ///< of caches of meshes

  bool diverges(const FrameDifference& f) const {
    return f.max > tolerance || f.max_speed > speed_tolerance || f.turn > turn_tolerance || f.spin > spin_tolerance ||
           f.scale > tolerance || f.scalar > tolerance;
  }
  /// The next frame; places: of b, the distances of each from a. Keeps the picture of the worst frame, of the last
  /// where nothing differs.
  void add(const FrameDifference& frame, std::vector<Vec3f> places, std::vector<float> distances, bool is_last);
  /// "vertex 12", or "instance 4031" by its id, "point 77", or "strand 1004, vertex 7".
  std::string element(int index) const;
  int diverging_count() const;
};

/// degrees: of instances.
CompareReport compare_caches(CacheReader& a, CacheReader& b, double tolerance, double degrees = 0);

/// Pairs up files or folders and compares all; one report per pair, sorted by name. Never empty.
std::vector<CompareReport> compare_paths(const std::filesystem::path& a, const std::filesystem::path& b,
                                         double tolerance, double degrees = 0);

/// The worst of all.
CompareVerdict overall_verdict(const std::vector<CompareReport>& reports);
int exit_code(CompareVerdict verdict);

/// The command: prints the report, writes what is asked for, gives the exit code.
int run_compare(const CompareOptions& options);

}  // namespace ft::inline baker

// Fields of moving air. Each kind is a file beside this and a line in registry.cpp; the contract tests run over the
// list. A field is a function of place and time alone, so that whoever asks, in whatever order and from however many
// threads, gets the same bits.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::inline solvers {

class VelocityGrid;
class BodyPaths;

/// The air's velocity at one time [m/s], at any place [m]. Finite everywhere; may be asked by several threads at once.
class AirNow {
 public:
  virtual ~AirNow() = default;
  virtual Vec3 velocity(const Vec3& place) const = 0;
};

/// What a shot file says of a field. A kind reads the members that its file names and leaves the others.
struct WindFieldSpec {
  static constexpr double k_unlimited = std::numeric_limits<double>::infinity();

  std::string name;                                 ///< for messages
  std::string kind;                                 ///< "uniform", "source", "vortex" ...
  double gain = 1;                                  ///< of its velocity [1]
  double from = -k_unlimited, until = k_unlimited;  ///< blows in between [s from the shot's first frame]
  double clock = 0;  ///< of gusts and eddies, at the shot's first frame [s]: a part of a shot has those of the whole
  double fade = 0;   ///< grows for so long after `from`, fades for so long after `until` [s]

  Vec3 velocity = Vec3::Zero();              ///< m/s: of a uniform wind; of a doublet's sphere; with which eddies drift
  double gusts = 0;                          ///< root mean square of a uniform wind's changes, by its speed [1]
  double gust_time = 3;                      ///< how long a gust lasts, about [s]
  Vec3 position = Vec3::Zero();              ///< centre of source, sink, vortex, doublet; offset of a grid [m]
  Vec3 axis = Vec3::UnitY();                 ///< of a vortex; not zero
  double flow = 0;                           ///< of a source or sink [m3/s]
  double circulation = 0;                    ///< of a vortex [m2/s]
  double radius = 0.1;                       ///< core of source, sink and vortex; of a doublet's sphere [m], > 0
  double intensity = 0;                      ///< of turbulence, root mean square of each component [m/s]
  double length = 1;                         ///< of its larger eddies [m], > 0
  std::uint64_t seed = 1;                    ///< of gusts and turbulence
  std::shared_ptr<const VelocityGrid> grid;  ///< of a grid
  std::shared_ptr<const BodyPaths> bodies;   ///< of a wake
  double turbulence = 0.4;                   ///< of a wake, root mean square by its mean velocity [1]
};

class WindField {
 public:
  explicit WindField(WindFieldSpec spec) : spec_(std::move(spec)) {}
  virtual ~WindField() = default;
  WindField(const WindField&) = delete;
  WindField& operator=(const WindField&) = delete;

  const WindFieldSpec& spec() const { return spec_; }
  /// At a time [s from the shot's first frame; negative in the pre-roll], at full strength. Must not outlive the field.
  virtual std::unique_ptr<AirNow> at_time(double time) const = 0;
  /// It is nowhere and never faster, at full strength [m/s].
  virtual double fastest() const = 0;
  /// Its divergence is zero all over, but for the cores of sources and sinks.
  virtual bool is_divergence_free() const { return false; }
  /// Of `gain`, at a time: 0 where it is switched off [1].
  double strength(double time) const;

 private:
  WindFieldSpec spec_;
};

}  // namespace ft::inline solvers

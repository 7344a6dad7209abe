#include "solvers/water/pond/pond_state.h"

#include <cstring>
#include <type_traits>

#include "baker/core/check.h"
#include "solvers/water/droplet_numbers.h"

namespace ft::inline solvers {
namespace {

/// Structs of doubles only, one after another.
template <class T>
std::vector<double> numbers(const std::vector<T>& from) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  std::vector<double> out(from.size() * sizeof(T) / sizeof(double));
  if (!out.empty()) std::memcpy(out.data(), from.data(), out.size() * sizeof(double));
  return out;
}
template <class T>
std::vector<T> structs(const std::vector<double>* from) {
  constexpr std::size_t width = sizeof(T) / sizeof(double);
  CHECK(from && from->size() % width == 0);
  std::vector<T> out(from->size() / width);
  if (!out.empty()) std::memcpy(static_cast<void*>(out.data()), from->data(), from->size() * sizeof(double));
  return out;
}

constexpr std::size_t k_float_width = 18;

}  // namespace

PondMemory take(const State& state, std::size_t float_count, std::size_t part_count) {
  PondMemory out;
  const auto* floats = state.find("floats");
  const auto* volumes = state.find("volumes");
  const auto* droplets = state.find("droplets");
  CHECK(floats && floats->size() == k_float_width * float_count);
  CHECK(volumes && volumes->size() == part_count);
  CHECK(droplets && droplets->size() % k_droplet_numbers == 0);
  for (std::size_t i = 0; i < float_count; ++i) {
    const double* f = floats->data() + i * k_float_width;
    RigidMotion m;
    m.pose.position = Vec3(f[0], f[1], f[2]);
    m.pose.rotation.coeffs() << f[3], f[4], f[5], f[6];
    m.velocity = Vec3(f[7], f[8], f[9]), m.spin = Vec3(f[10], f[11], f[12]);
    out.floats.motion.push_back(m);
    out.floats.splash_energy.push_back(f[13]), out.floats.splash_speed.push_back(f[14]);
    out.floats.wake.push_back(Vec3(f[15], f[16], f[17]));
  }
  out.floats.volume = *volumes;
  out.droplets = read_droplets(*droplets);
  out.cavities = structs<CavitySlice>(state.find("cavities"));
  out.crossings = structs<Crossing>(state.find("driven"));
  out.account = structs<PondAccount>(state.find("account")).at(0);
  return out;
}

void put(const PondMemory& memory, State& state) {
  std::vector<double> floats;
  for (std::size_t i = 0; i < memory.floats.motion.size(); ++i) {
    const RigidMotion& m = memory.floats.motion[i];
    const Vec3 &x = m.pose.position, &v = m.velocity, &w = m.spin, &k = memory.floats.wake[i];
    const auto& q = m.pose.rotation.coeffs();
    floats.insert(floats.end(), {x[0], x[1], x[2], q[0], q[1], q[2], q[3], v[0], v[1], v[2], w[0], w[1], w[2],
                                 memory.floats.splash_energy[i], memory.floats.splash_speed[i], k[0], k[1], k[2]});
  }
  state.set("floats", std::move(floats));
  state.set("volumes", memory.floats.volume);
  state.set("droplets", write_droplets(memory.droplets));
  state.set("cavities", numbers(memory.cavities));
  state.set("driven", numbers(memory.crossings));
  state.set("account", numbers(std::vector<PondAccount>{memory.account}));
}

}  // namespace ft::inline solvers

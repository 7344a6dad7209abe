// Transform chains: see alembic_transform.h. An operation is one byte, kind in the upper half; angles are degrees;
// matrices are stored row by row for row vectors, so that they are transposed here.
#include "io/cache/alembic_transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline io::alembic {
namespace {

enum Operation { k_scale, k_translate, k_rotate, k_matrix, k_rotate_x, k_rotate_y, k_rotate_z, k_operation_count };
constexpr std::size_t k_channels[k_operation_count] = {3, 3, 4, 16, 1, 1, 1};

Eigen::Affine3d matrix_of(int operation, const double* v) {
  const auto rotation = [](const Vec3& axis, double angle_deg) {
    const double length = axis.norm();
    if (!(length > 0)) return Eigen::Affine3d::Identity();
    return Eigen::Affine3d(Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis / length));
  };
  switch (operation) {
    case k_scale: return Eigen::Affine3d(Eigen::Scaling(v[0], v[1], v[2]));
    case k_translate: return Eigen::Affine3d(Eigen::Translation3d(v[0], v[1], v[2]));
    case k_rotate: return rotation({v[0], v[1], v[2]}, v[3]);
    case k_rotate_x: return rotation(Vec3::UnitX(), v[0]);
    case k_rotate_y: return rotation(Vec3::UnitY(), v[0]);
    case k_rotate_z: return rotation(Vec3::UnitZ(), v[0]);
    default: {
      Eigen::Affine3d m = Eigen::Affine3d::Identity();
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) m(row, column) = v[4 * column + row];
      return m;
    }
  }
}

const Property* samples_of(const Property& xform, std::string_view name) {
  const Property* p = xform.find(name);
  return p == nullptr || p->kind == PropertyKind::k_compound || p->samples.empty() ? nullptr : p;
}

}  // namespace

double sample_time(const TimeSampling& times, std::uint32_t index) {
  const auto count = static_cast<std::uint32_t>(times.times.size());
  // All times listed: the cycle is so long that it never comes round.
  if (times.time_per_cycle > 1e300) return times.times[std::min(index, count - 1)];
  return times.times[index % count] + times.time_per_cycle * (index / count);
}

Result<TransformChain> TransformChain::read(const InputFile& file, const Archive& archive,
                                            const std::vector<Property>& xforms) {
  TransformChain chain;
  const auto fault = [&](const char* what) {
    return input_error(std::string("is damaged: ") + what, file.path().string());
  };
  for (const Property& xform : xforms) {
    if (const Property* inherits = samples_of(xform, ".inherits")) {
      const auto value = read_values(file, inherits->samples.front());
      if (!value) return value.error();
      if (value.value().size() == 1 && value.value()[0] == std::byte{0}) chain.links_.clear();
    }
    const Property *operations = samples_of(xform, ".ops"), *values = samples_of(xform, ".vals");
    if (operations == nullptr || values == nullptr) continue;
    if (operations->pod != Pod::k_u8 || values->pod != Pod::k_f64) return fault("a transform of unknown numbers");
    Link link;
    const auto codes = read_values(file, operations->samples.front());
    if (!codes) return codes.error();
    std::size_t channels = 0;
    for (const std::byte code : codes.value()) {
      const auto operation = static_cast<std::uint8_t>(code) >> 4;
      if (operation >= k_operation_count) return fault("an unknown transform");
      link.operations.push_back(static_cast<std::uint8_t>(operation));
      channels += k_channels[operation];
    }
    for (std::uint32_t i = 0; i < (values->constant() ? 1 : values->sample_count); ++i) {
      const auto raw = read_values(file, values->samples[values->slot_of(i)]);
      if (!raw) return raw.error();
      ByteReader in(raw.value());
      link.values.push_back(in.read_array<double>(raw.value().size() / sizeof(double)));
      const auto& numbers = link.values.back();
      if (numbers.size() < channels ||
          !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        return fault("a transform lacks numbers");
    }
    link.times = archive.time_samplings[values->time_sampling];
    chain.links_.push_back(std::move(link));
  }
  return chain;
}

bool TransformChain::constant() const {
  return std::all_of(links_.begin(), links_.end(), [](const Link& l) { return l.values.size() == 1; });
}

Eigen::Affine3d TransformChain::at(double time) const {
  Eigen::Affine3d total = Eigen::Affine3d::Identity();
  for (const Link& link : links_) total = total * link.matrix(time);
  return total;
}

Eigen::Affine3d TransformChain::Link::matrix(double time) const {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(sample_time(times, static_cast<std::uint32_t>(i)) - time) <
        std::abs(sample_time(times, static_cast<std::uint32_t>(nearest)) - time))
      nearest = i;
  Eigen::Affine3d total = Eigen::Affine3d::Identity();
  const double* channel = values[nearest].data();
  for (const std::uint8_t operation : operations) {
    total = total * matrix_of(operation, channel);
    channel += k_channels[operation];
  }
  return total;
}

}  // namespace ft::inline io::alembic

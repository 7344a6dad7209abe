#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "baker/core/types.h"
#include "solvers/energies/fabric.h"

namespace ft {
namespace {

TEST(Fabrics, Promised_fabrics_are_listed) {
  for (const char* name : {"jersey", "cotton", "denim", "silk", "wool", "ripstop"})
    EXPECT_NE(find_fabric(name), nullptr) << name;
  EXPECT_EQ(find_fabric("unobtainium"), nullptr);
  EXPECT_EQ(find_fabric(""), nullptr);
}

TEST(Fabrics, Names_are_different_and_every_fabric_has_a_source) {
  std::set<std::string> names;
  for (const Fabric& f : fabrics()) {
    EXPECT_TRUE(names.insert(f.name).second) << f.name;
    EXPECT_GT(f.source.size(), 20u) << f.name;
    EXPECT_EQ(find_fabric(f.name), &f);
  }
}

TEST(Fabrics, Every_value_lies_in_its_allowed_range) {
  for (const Fabric& f : fabrics())
    for (const FabricKey& key : fabric_keys()) {
      const auto value = fabric_value(f, key.key);
      ASSERT_TRUE(value.has_value()) << key.key;
      EXPECT_GE(*value, key.lowest) << f.name << " " << key.key;
      EXPECT_LE(*value, key.highest) << f.name << " " << key.key;
    }
}

// Textile books give cantilever bending lengths of 1 cm (limp silk) to 6 cm (canvas); a value outside is a slip of a
// unit.
TEST(Fabrics, Bending_length_is_between_1_and_6_centimetres) {
  for (const Fabric& f : fabrics())
    for (const double rigidity : {f.bend_warp, f.bend_weft}) {
      const double length = std::cbrt(rigidity / (f.mass_per_area * k_gravity));
      EXPECT_GT(length, 0.01) << f.name;
      EXPECT_LT(length, 0.06) << f.name;
    }
}

// A hanging sheet of 1 m stretches by rho g H / (2 E) on average: 2 % for the stretchiest knits, less for all others.
TEST(Fabrics, Membranes_are_stable_and_carry_their_own_weight) {
  for (const Fabric& f : fabrics()) {
    EXPECT_LT(f.poisson, 1.0) << f.name;
    EXPECT_GT(f.shear, 0.0) << f.name;
    EXPECT_LT(f.mass_per_area * k_gravity / (2 * std::min(f.stretch_warp, f.stretch_weft)), 0.021) << f.name;
  }
}

TEST(Fabrics, Order_of_the_fabrics_is_that_of_the_hand) {
  const auto bend = [](const char* name) { return find_fabric(name)->bend_warp + find_fabric(name)->bend_weft; };
  EXPECT_LT(bend("silk"), bend("cotton"));
  EXPECT_LT(bend("cotton"), bend("denim"));
  const auto stretch = [](const char* name) { return find_fabric(name)->stretch_weft; };
  EXPECT_LT(stretch("jersey"), stretch("cotton"));
  EXPECT_LT(stretch("cotton"), stretch("ripstop"));
  EXPECT_LT(find_fabric("silk")->mass_per_area, find_fabric("denim")->mass_per_area);
}

TEST(Fabrics, Every_key_sets_its_own_value_and_no_other) {
  for (const FabricKey& key : fabric_keys()) {
    Fabric f = *find_fabric("cotton");
    ASSERT_TRUE(set_fabric_value(f, key.key, 0.123));
    for (const FabricKey& other : fabric_keys())
      EXPECT_EQ(*fabric_value(f, other.key),
                other.key == key.key ? 0.123 : *fabric_value(*find_fabric("cotton"), other.key));
  }
  Fabric f;
  EXPECT_FALSE(set_fabric_value(f, "colour", 1));
  EXPECT_FALSE(fabric_value(f, "name").has_value());
}

}  // namespace
}  // namespace ft

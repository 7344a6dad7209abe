#include "io/shot/garment_size.h"

#include <gtest/gtest.h>

#include <limits>

namespace ft {
namespace {

TEST(GarmentSize, What_may_be_a_garment_is_not_doubted) {
  for (const double size : {0.02, 0.3, 1.0, 4.0, 10.0})
    for (const double scale : {0.01, 1.0}) EXPECT_EQ(doubt_of_size(size, scale), "") << size;
  EXPECT_EQ(doubt_of_size(0, 1), "");
  EXPECT_EQ(doubt_of_size(std::numeric_limits<double>::quiet_NaN(), 1), "");
}

TEST(GarmentSize, A_slip_of_units_is_told_with_the_unit_scale_that_mends_it) {
  EXPECT_EQ(doubt_of_size(58, 1),
            "is 58 m in size, which no garment is: with unit_scale = 0.01 (a file in centimetres) it would be 0.58 m");
  const auto expect = [](double size, double scale, const char* words) {
    EXPECT_NE(doubt_of_size(size, scale).find(words), std::string::npos) << doubt_of_size(size, scale);
  };
  expect(1400, 1, "unit_scale = 0.001 (a file in millimetres) it would be 1.4 m");
  expect(0.012, 0.01, "unit_scale = 1 (a file in metres) it would be 1.2 m");
  expect(0.006, 1, "unit_scale = 100 ");
  expect(1e9, 1, "is 1e+09 m in size, which no garment is: is unit_scale right?");
}

}  // namespace
}  // namespace ft

#include "baker/core/file.h"

#include <gtest/gtest.h>

#include "baker/core/random.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

TEST(File, Hash_of_a_file_is_that_of_its_bytes_whatever_their_number) {
  const test::ScratchFolder scratch;
  constexpr std::size_t k_part = std::size_t{1} << 20;  // what is read at once
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, k_part - 1, k_part, k_part + 1, 3 * k_part}) {
    Bytes data(size);
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::byte>(256 * random_uniform({1, 0, 0, i}, 0));
    ASSERT_TRUE(write_file_durably(scratch / "a", std::span<const std::byte>(data)));
    const auto content = hash_file(scratch / "a");
    ASSERT_TRUE(content);
    EXPECT_EQ(content->bytes, size);
    EXPECT_EQ(content->hash, hash_bytes(data));
    EXPECT_EQ(read_file(scratch / "a").value(), data);
  }
}

TEST(File, What_is_no_file_has_no_hash) {
  const test::ScratchFolder scratch;
  EXPECT_FALSE(hash_file(scratch / "none"));
  EXPECT_FALSE(hash_file(scratch.path()));
}

}  // namespace
}  // namespace ft

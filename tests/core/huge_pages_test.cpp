#include "baker/core/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "baker/core/give_back.h"

namespace ft {
namespace {

using List = std::vector<std::uint32_t, HugePages<std::uint32_t>>;

/// Entries of a huge page.
constexpr std::size_t k_page = k_huge_page / sizeof(std::uint32_t);

TEST(HugePages, A_list_keeps_its_numbers_as_it_grows_into_huge_pages) {
  List list;
  for (std::uint32_t i = 0; i < 5 * k_page / 2; ++i) list.push_back(i);
  for (std::uint32_t i = 0; i < list.size(); ++i) ASSERT_EQ(list[i], i);
}

TEST(HugePages, Lists_of_a_page_and_a_little_less_or_more_hold_what_they_are_given) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, k_page - 1, k_page, k_page + 1, 3 * k_page + 7}) {
    List a(count, 1), b(count, 2);  // beside each other
    std::iota(a.begin(), a.end(), 0u);
    for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(a[i] == i && b[i] == 2) << count;
    b = a;
    EXPECT_EQ(a, b);
  }
}

TEST(HugePages, Room_begins_at_a_huge_page_and_is_free_again_for_others) {
  for (int round = 0; round < 2000; ++round) {  // 20 GB, were it not
    List list(5 * k_page + 1);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(list.data()) % k_huge_page, 0u);
    list.front() = list.back() = 1;
  }
}

TEST(HugePages, A_list_that_is_given_back_has_no_room) {
  List list(k_page, 1);
  give_back(list);
  EXPECT_EQ(list.capacity(), 0u);
}

TEST(HugePages, More_than_there_is_is_refused) {
  EXPECT_THROW(new_huge_pages(std::size_t{1} << 60), std::bad_alloc);
}

}  // namespace
}  // namespace ft

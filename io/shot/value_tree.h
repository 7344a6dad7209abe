// The shot file as a tree of values that know where they stand. toml++ stays behind this header (value_tree.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

struct Place {
  int line = 0, column = 0;  ///< from 1; 0: nowhere in the file
  std::string command;       ///< "--set cloth.dress.fabric=denim" when the value came from there
};

struct Member;

struct Value {
  enum class Kind { k_flag, k_integer, k_number, k_text, k_list, k_table, k_date };
  Kind kind = Kind::k_table;
  Place place;
  bool flag = false;
  bool loose = false;  ///< from the command line, where quotes are lost: 12 may be meant as "12"
  std::int64_t integer = 0;
  double number = 0;  ///< also set for integers
  std::string text;   ///< strings; for loose values the words as typed
  std::vector<Value> items;
  std::vector<Member> members;  ///< in the order of the file

  const Member* find(std::string_view key) const;
  Member* find(std::string_view key);
};

struct Member {
  std::string key;
  Place place;  ///< of the key
  Value value;
};

/// "a list", "the number 12", "the text \"12\"": what a value is, for messages.
std::string describe(const Value& value);

struct ParseFault {
  Place place;
  std::string message;
};

/// The whole file, or the first fault of syntax (nothing behind it can be understood).
bool parse_tree(std::string_view text, Value& root, ParseFault& fault);

/// One override "cloth.dress.fabric=denim": path of keys and the value, which may be TOML or bare words.
bool parse_override(std::string_view text, std::vector<std::string>& path, Value& value, std::string& fault);

}  // namespace ft::inline io

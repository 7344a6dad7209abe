// CHECK(a <= b): our own mistakes, on in every build. A failed check prints where and what and ends the process with
// exit code 70; whatever was on disk before stays valid, because files appear by rename or are valid after every frame.
#pragma once

namespace ft {
[[noreturn]] void check_failed(const char* expression, const char* file, int line);
}

#define CHECK(expression)                                  \
  do {                                                     \
    if (!(expression)) [[unlikely]]                        \
      ::ft::check_failed(#expression, __FILE__, __LINE__); \
  } while (false)

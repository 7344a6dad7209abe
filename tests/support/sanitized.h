// What a sanitized build leaves out, said aloud: such a build is 5 to 30 times slower, and the same lines are reached
// by a smaller sample. Only for tests whose number of cases is a matter of patience.
#pragma once

#include <cstddef>
#include <cstdio>

namespace ft::test {

// g++ says by a macro of its own what clang says by a feature.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer)
#define __SANITIZE_THREAD__ 1
#endif
#endif

#ifdef __SANITIZE_THREAD__
inline constexpr bool k_thread_sanitized = true;
#else
inline constexpr bool k_thread_sanitized = false;
#endif
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool k_sanitized = true;
#else
inline constexpr bool k_sanitized = k_thread_sanitized;
#endif

/// 1, and in a sanitized build `step`: only every step-th case is tried, which is printed.
inline std::size_t every(std::size_t step, const char* what) {
  if (!k_sanitized) return 1;
  std::printf("  sanitized build: only every %zuth of the %s is tried\n", step, what);
  return step;
}

}  // namespace ft::test

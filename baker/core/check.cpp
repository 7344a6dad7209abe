#include "baker/core/check.h"

#include <unistd.h>

#include <cstdio>
#include <cstring>

namespace ft {

void check_failed(const char* expression, const char* file, int line) {
  const char* base = std::strrchr(file, '/');
  std::fprintf(stderr, "followthrough: internal error: %s (%s:%d); please report it with the shot file\n", expression,
               base ? base + 1 : file, line);
  std::fflush(stderr);
  ::_exit(70);
}

}  // namespace ft

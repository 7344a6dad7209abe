#include "io/shot/secondary.h"

namespace ft::inline io {

std::string_view SecondarySpec::kind() const {
  return section->name();
}

std::string SecondarySpec::owner() const {
  return std::string(kind()) + " " + in_quotes(name);
}

}  // namespace ft::inline io

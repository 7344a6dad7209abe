#include "baker/core/result.h"

namespace ft {

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::k_usage: return 2;
    case ErrorKind::k_input: return 3;
    case ErrorKind::k_quality: return 4;
    case ErrorKind::k_diverged: return 5;
    case ErrorKind::k_output: return 6;
    case ErrorKind::k_interrupted: return 130;
    case ErrorKind::k_bug: return 70;
  }
  return 70;
}

std::string Error::text() const {
  std::string out;
  if (!where.empty()) out += where + ": ";
  out += what;
  if (!hint.empty()) out += " (" + hint + ")";
  return out;
}

Error usage_error(std::string what, std::string where, std::string hint) {
  return {ErrorKind::k_usage, std::move(what), std::move(where), std::move(hint)};
}

Error input_error(std::string what, std::string where, std::string hint) {
  return {ErrorKind::k_input, std::move(what), std::move(where), std::move(hint)};
}

Error output_error(std::string what, std::string where, std::string hint) {
  return {ErrorKind::k_output, std::move(what), std::move(where), std::move(hint)};
}

}  // namespace ft

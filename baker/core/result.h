// Result<T>: a value or an Error that says what, where, and what to try. Used wherever files, text, disk or the
// importer can fail. Nothing throws across a module boundary.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "baker/core/check.h"

namespace ft {

/// What kind of failure; each has one exit code of the program.
enum class ErrorKind {
  k_usage,        ///< 2: wrong usage or shot file
  k_input,        ///< 3: input missing or unreadable
  k_quality,      ///< 4: quality gate failed
  k_diverged,     ///< 5: diverged
  k_output,       ///< 6: output or disk
  k_interrupted,  ///< 130: interrupted, resumable
  k_bug,          ///< 70: our own mistake
};

int exit_code(ErrorKind kind);

struct Error {
  ErrorKind kind = ErrorKind::k_input;
  std::string what;   ///< the fault, in one sentence
  std::string where;  ///< "shot.toml:14:7", "frame 118, cape, vertex 4031", a path; may be empty
  std::string hint;   ///< what to try; may be empty

  /// "where: what (hint)".
  std::string text() const;
};

Error usage_error(std::string what, std::string where = {}, std::string hint = {});
Error input_error(std::string what, std::string where = {}, std::string hint = {});
Error output_error(std::string what, std::string where = {}, std::string hint = {});

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : data_(std::move(value)) {}
  Result(Error error) : data_(std::move(error)) {}

  explicit operator bool() const { return ok(); }
  bool ok() const { return data_.index() == 0; }
  T& value() & { return get(); }
  const T& value() const& { return const_cast<Result*>(this)->get(); }
  T&& value() && { return std::move(get()); }
  T& operator*() & { return get(); }
  const T& operator*() const& { return const_cast<Result*>(this)->get(); }
  T* operator->() { return &get(); }
  const T* operator->() const { return &const_cast<Result*>(this)->get(); }
  const Error& error() const {
    CHECK(!ok());
    return std::get<1>(data_);
  }

 private:
  T& get() {
    CHECK(ok());
    return std::get<0>(data_);
  }
  std::variant<T, Error> data_;
};

/// Success without a value, or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return ok(); }
  bool ok() const { return !error_.has_value(); }
  const Error& error() const {
    CHECK(!ok());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace ft

// Where the time of a bake went, for --profile: listens to the progress events, prints a table at the end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "baker/run/progress.h"

namespace ft::inline baker {

class ProfileText {
 public:
  ProfileText();
  /// Hears the events; may outlive this.
  std::unique_ptr<Progress> listener();
  std::vector<std::string> lines() const;

 private:
  struct Sums;
  std::shared_ptr<Sums> sums_;
};

}  // namespace ft::inline baker

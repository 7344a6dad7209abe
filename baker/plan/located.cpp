#include "baker/plan/located.h"

namespace ft::inline baker {

Error located(Error error, const Shot& shot, const std::string& owner) {
  error.where = shot.file.filename().string() + ": " + owner + (error.where.empty() ? "" : ": " + error.where);
  return error;
}

}  // namespace ft::inline baker

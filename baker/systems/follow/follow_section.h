// [follow.NAME] for the shot file's reader.
#pragma once

#include "io/shot/secondary.h"

namespace ft::inline baker {

const SecondarySection& follow_section();

}  // namespace ft::inline baker

// [follow.NAME] for the shot file's reader.
#pragma once

#include "io/shot/secondary.h"

namespace ft {

const SecondarySection& follow_section();

}  // namespace ft

// --set section.key=value: put into the tree before it is read, so that it is judged by the same table as the file.
#pragma once

#include <string>

#include "io/shot/shot.h"
#include "io/shot/shot_values.h"

namespace ft::inline io {

/// "cloth.dress.fabric=denim". Named sections need to exist; other sections are made when they are missing.
void apply_override(Value& root, const std::string& text, const ShotVocabulary& vocabulary, FaultList& faults);

}  // namespace ft::inline io

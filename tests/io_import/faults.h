// Situations in which characters came in wrong, as small files with the right positions: shared/assets/faults/NAME with
// shot.toml and expected.txt.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "io/import/import.h"

namespace ft::test {

std::filesystem::path fault_folder(const std::string& name);

/// What the folder's shot.toml asks of its first primary; file = another file of the folder, or empty: the shot's own.
ImportRequest fault_request(const std::string& name, const std::string& file = {});

/// "frame N: lowest x y z .. highest x y z" of expected.txt, by frame [m, Y-up]; written with four decimals.
std::map<int, Box> expected_boxes(const std::string& name);

/// Largest difference [m] of a coordinate of the box of all vertices from the expected one, over all frames of
/// expected.txt. Below 6.7e-5 is right: half a unit of the last decimal, and 1e-5 of a figure of 1.7 m.
double fault_error(const std::string& name, const ImportedPrimary& imported);

}  // namespace ft::test

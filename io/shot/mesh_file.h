// Garment meshes from OBJ, in the file's own vertex order (assimp would split shared vertices). Every fault is named,
// all at once. For the conductor and for topologies of geometry caches. Caution: positions come in the file's unit and
// axes; the caller applies unit_scale, up and offset of the shot file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "io/shot/file_numbers.h"

namespace ft::inline io {

/// Reads v, vt, f (negative and v/vt/vn indices), g/o (face groups become vertex groups), vertex colours (groups "red",
/// "green", "blue" with the channel as weight), seam and stitch lines (see obj_read.cpp). Unknown lines are skipped.
/// Refuses numbers that are not finite, faces with fewer than three corners and indices that name nothing; uvs are kept
/// only when every corner has one.
/// Colours are from 0 to 1, or from 0 to 255 where one is above 1; `notes`, if asked for, says how they were read then.
Result<Mesh> read_obj(const std::filesystem::path& path, std::vector<std::string>* notes = nullptr);

/// The same from text; `where` stands in front of line numbers in messages.
Result<Mesh> parse_obj(std::string_view text, std::string_view where, std::vector<std::string>* notes = nullptr);

/// Shortest digits that read back to the same doubles. Groups come back where they consist of whole faces with weight
/// 1; groups "red", "green", "blue" are written as vertex colours.
Status write_obj(const std::filesystem::path& path, const Mesh& mesh);

/// What stands against simulating a mesh. Vertices, faces and stitches have their numbers `in_file`.
struct GarmentFindings {
  std::vector<std::string> faults;  ///< cannot be simulated
  std::vector<std::string> notes;   ///< tolerated: isolated vertices (carried rigidly), mixed winding, several pieces
};
GarmentFindings inspect_garment(const Mesh& mesh, const FileNumbers& in_file = {});

/// Refuses what cannot be simulated: no faces, NaN or infinite vertices, zero-area faces, edges with more than two
/// faces, vertices used twice in a face, coincident vertices, stitches of a vertex with itself or with what is in no
/// face. One message with the count and the first places of each fault. Vertices that no face uses are tolerated: they
/// stay in the cache.
Status check_garment(const Mesh& mesh, const FileNumbers& in_file = {});

/// Pieces of connected faces, before anything is sewn.
int panel_count(const Mesh& mesh);

/// Refuses a mesh whose uvs are no pattern to cut it from: none, or faces without an area in them. Assumes a mesh that
/// is good. `notes` says what looks wrong: a pattern of quite another size than the mesh, at `scale` m per unit of uvs.
Status check_pattern(const Mesh& mesh, double scale, std::vector<std::string>& notes, const FileNumbers& in_file = {});

}  // namespace ft::inline io

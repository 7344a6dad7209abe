// Uses a little of every floor: reads a mesh, lets crossings be counted, names the fabrics, lists the formats.
#include <cstdio>

#include "collision/check/crossings.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "solvers/energies/fabric.h"

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto mesh = ft::read_obj(argv[1]);
  if (!mesh) return std::fprintf(stderr, "%s\n", mesh.error().text().c_str()), 1;
  const auto triangles = ft::triangulate(*mesh);
  const auto crossings = ft::crossings_within(mesh->positions, triangles);
  std::printf("%d vertices, %zu crossings, %zu fabrics, %zu formats\n", mesh->vertex_count(), crossings.size(),
              ft::fabrics().size(), ft::cache_formats().size());
  return ft::fabrics().empty() || ft::cache_formats().empty() ? 1 : 0;
}

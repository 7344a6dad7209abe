// make_garments CHARACTER --kind skirt|top --out FILE.obj: tailors a garment to a character's bind pose, for the
// samples. The character is read as a bake reads it (import_primary), so the garment fits in place; a plain OBJ is
// taken as the body itself, in metres, Y-up. Says how well the result fits and ends with 1 when it touches the body.
// Caution: the tailoring is geometric and knows standing two-legged bodies only.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "samples/tools/body_slices.h"
#include "samples/tools/garment_check.h"
#include "samples/tools/skirt.h"
#include "samples/tools/top.h"

namespace ft::garments {
namespace {

struct Arguments {
  ImportRequest request;
  std::string kind = "skirt", out, body_out, name;
  double waist = 0;  ///< share of the height
  SkirtSettings skirt;
  TopSettings top;
};

Result<Body> read_body(const Arguments& arguments) {
  Body body;
  if (arguments.request.file.extension() == ".obj") {
    auto mesh = read_obj(arguments.request.file);
    if (!mesh) return mesh.error();
    body.triangles = triangulate(*mesh);
    body.positions = std::move(mesh->positions);
    return body;
  }
  auto primary = import_primary(arguments.request);
  if (!primary) return primary.error();
  const Trajectory& trajectory = *primary->trajectory;
  body.triangles = trajectory.surface().triangles;
  body.positions.resize(static_cast<std::size_t>(trajectory.surface().vertex_count()));
  trajectory.bind_pose(body.positions);
  return body;
}

Result<Mesh> tailor(Body body, const Arguments& arguments) {
  const Eigen::Isometry3d turn = arms_along_x(body);
  for (Vec3& p : body.positions) p = turn * p;
  auto shape = measure_body(body, arguments.waist);
  if (!shape) return shape.error();
  fmt::print(
      "body: {:.3f} m tall, waist at {:.3f} m, crotch {:.3f}, neck {:.3f}, shoulders begin at {:.3f}, chest {:.3f} "
      "wide\n",
      shape->bounds.size().y(), shape->waist, shape->crotch, shape->neck, shape->neck_base,
      2 * shape->chest_half_width);
  Result<Mesh> mesh = arguments.kind == "top" ? make_top(body, *shape, arguments.top)
                                              : Result<Mesh>(make_skirt(*shape, arguments.skirt));
  if (!mesh) return mesh;
  // A hundredth of a millimetre is fine enough for a tailor, and keeps the file short.
  for (Vec3& p : mesh->positions) p = ((turn.inverse() * p) * 1e5).array().round() / 1e5;
  for (Vec2& uv : mesh->uvs) uv = (uv * 1e5).array().round() / 1e5;
  if (!arguments.name.empty()) mesh->name = arguments.name;
  return mesh;
}

int run(const Arguments& arguments) {
  const auto fail = [](const Error& error) {
    fmt::print(stderr, "make_garments: {}\n", error.text());
    return exit_code(error.kind);
  };
  auto body = read_body(arguments);
  if (!body) return fail(body.error());
  if (!arguments.body_out.empty())
    if (Status status = write_obj(arguments.body_out, make_triangle_mesh("body", body->positions, body->triangles));
        !status)
      return fail(status.error());
  auto mesh = tailor(*body, arguments);
  if (!mesh) return fail(mesh.error());
  if (Status status = check_garment(*mesh); !status) return fail(status.error());
  if (Status status = write_obj(arguments.out, *mesh); !status) return fail(status.error());
  const std::vector<Triangle> triangles = triangulate(*mesh);
  const ShapeQuality quality = shape_quality(mesh->positions, triangles);
  const int crossings = count_crossings(mesh->positions, triangles, body->positions, body->triangles);
  fmt::print(
      "{}: {} vertices, {} faces, edges {:.1f} to {:.1f} mm (median {:.1f}), smallest angle {:.0f} degrees (1 % below "
      "{:.0f}), {} crossings with the body\n",
      arguments.out, mesh->vertex_count(), mesh->face_count(), 1e3 * quality.shortest_edge, 1e3 * quality.longest_edge,
      1e3 * quality.median_edge, quality.smallest_angle_deg, quality.angle_deg_p1, crossings);
  return crossings == 0 ? 0 : 1;
}

int main_checked(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Tailors a garment to a character's bind pose."};
  app.add_option("character", arguments.request.file, "character, motion capture, or OBJ")->required();
  app.add_option("--kind", arguments.kind, "skirt or top")->check(CLI::IsMember({"skirt", "top"}));
  app.add_option("--out", arguments.out, "OBJ to write")->required();
  app.add_option("--body-out", arguments.body_out, "also writes the body, an OBJ");
  app.add_option("--animation", arguments.request.animation, "second file with the motion");
  app.add_option("--topology", arguments.request.topology, "faces of a geometry cache, an OBJ");
  app.add_option("--mesh", arguments.request.meshes, "mesh of the character to use, may be repeated; default all");
  app.add_option("--unit-scale", arguments.request.unit_scale, "metres per file unit");
  app.add_option("--height", arguments.request.height, "metres");
  app.add_option("--body", arguments.request.body, "of motion capture: blended or capsules");
  app.add_option("--fps", arguments.request.shot_fps, "frames per second of the shot");
  app.add_option("--source-fps", arguments.request.source_fps, "frames per second of a geometry cache");
  app.add_option("--waist", arguments.waist, "waist height in shares of the body's height, 0.4..0.8")
      ->check(CLI::Range(0.4, 0.8));
  app.add_option("--rings", arguments.skirt.rings, "skirt: points from waist to hem")->check(CLI::Range(3, 2000));
  app.add_option("--segments", arguments.skirt.segments, "skirt: points around")->check(CLI::Range(8, 5000));
  app.add_option("--length", arguments.skirt.length, "skirt: metres")->check(CLI::Range(0.02, 3.0));
  app.add_option("--flare", arguments.skirt.flare, "skirt: growth of the radius, metres")->check(CLI::Range(0.0, 2.0));
  app.add_option("--clearance", arguments.skirt.clearance, "skirt: metres from the body")->check(CLI::Range(1e-3, 0.1));
  app.add_option("--cell", arguments.top.cell, "top: edge length, metres")->check(CLI::Range(2e-3, 0.1));
  app.add_option("--distance", arguments.top.distance, "top: metres from the body")->check(CLI::Range(2e-3, 0.1));
  app.add_option("--hem", arguments.top.hem, "top: metres above the waist");
  app.add_option("--sleeve", arguments.top.sleeve, "top: metres beyond the shoulder");
  CLI11_PARSE(app, argc, argv);
  return run(arguments);
}

}  // namespace
}  // namespace ft::garments

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--import-child") return ft::import_child_main(argc, argv);
  return ft::garments::main_checked(argc, argv);
}

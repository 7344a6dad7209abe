// make_garments CHARACTER --kind skirt|top --out FILE.obj: tailors a garment to a character's bind pose, for the
// samples. The character is read as a bake reads it (import_primary), so the garment fits in place; a plain OBJ is
// taken as the body itself, in metres, Y-up. Says how well the result fits. No garment is written that starts through
// the body or through itself: it is moved out, or the tool ends with 1 and says where. Caution: the tailoring is
// geometric and knows standing two-legged bodies only.
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

/// A garment that is nowhere nearer to the body than this [m] is left as it was cut.
constexpr double k_least_gap = 3e-3;

Result<Mesh> cut(const Body& body, const BodyShape& shape, const Arguments& arguments, bool within_arms) {
  if (arguments.kind == "top") return make_top(body, shape, arguments.top);
  SkirtSettings skirt = arguments.skirt;
  skirt.within_arms = within_arms;
  return make_skirt(shape, skirt);
}

/// A hundredth of a millimetre is fine enough for a tailor, and keeps the file short.
void round_places(Mesh& mesh) {
  for (Vec3& p : mesh.positions) p = (p * 1e5).array().round() / 1e5;
  for (Vec2& uv : mesh.uvs) uv = (uv * 1e5).array().round() / 1e5;
}

struct Tailored {
  Mesh mesh;
  Fit fit;
  double moved = 0;  ///< farthest that a vertex was pushed [m]
};

/// Cuts it, between hands and hips where it would run into the hands; then moves it out of what it still touches.
Result<Tailored> tailor(const Body& as_it_stands, const Arguments& arguments) {
  Body body = as_it_stands;
  const Eigen::Isometry3d turn = arms_along_x(body);
  for (Vec3& p : body.positions) p = turn * p;
  auto shape = measure_body(body, arguments.waist);
  if (!shape) return shape.error();
  fmt::print(
      "body: {:.3f} m tall, waist at {:.3f} m, crotch {:.3f}, neck {:.3f}, shoulders begin at {:.3f}, chest {:.3f} "
      "wide\n",
      shape->bounds.size().y(), shape->waist, shape->crotch, shape->neck, shape->neck_base,
      2 * shape->chest_half_width);
  Tailored out;
  for (const bool within_arms : {false, true}) {
    if (within_arms && arguments.kind == "top") break;
    Result<Mesh> mesh = cut(body, *shape, arguments, within_arms);
    if (!mesh) return mesh.error();
    out.mesh = std::move(*mesh);
    if (Status status = check_garment(out.mesh); !status) return status.error();
    for (Vec3& p : out.mesh.positions) p = turn.inverse() * p;
    round_places(out.mesh);
    out.fit = fit_of(out.mesh.positions, triangulate(out.mesh), as_it_stands);
    if (out.fit.clear() && out.fit.gap >= k_least_gap) break;
  }
  if (!arguments.name.empty()) out.mesh.name = arguments.name;
  if (out.fit.clear() && out.fit.gap >= k_least_gap) return out;
  const std::vector<Vec3> before = out.mesh.positions;
  const std::vector<Triangle> triangles = triangulate(out.mesh);
  move_out(out.mesh.positions, triangles, as_it_stands,
           arguments.kind == "top" ? arguments.top.clearance : arguments.skirt.clearance, k_least_gap);
  round_places(out.mesh);
  out.fit = fit_of(out.mesh.positions, triangles, as_it_stands);
  for (std::size_t v = 0; v < before.size(); ++v)
    out.moved = std::max(out.moved, (out.mesh.positions[v] - before[v]).norm());
  return out;
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
  auto garment = tailor(*body, arguments);
  if (!garment) return fail(garment.error());
  const Mesh& mesh = garment->mesh;
  const Fit& fit = garment->fit;
  if (!fit.clear()) {
    const Vec3& p = mesh.positions[at(fit.worst)];
    fmt::print(stderr,
               "make_garments: {}: not written, for it would start with {}, the worst at vertex {} ({:.3f}, {:.3f}, "
               "{:.3f}) (try another --waist, --length, --flare or --sleeve, or --mesh to leave out what is worn over "
               "it)\n",
               arguments.out, fit.text(), fit.worst, p.x(), p.y(), p.z());
    return 1;
  }
  if (Status status = write_obj(arguments.out, mesh); !status) return fail(status.error());
  const ShapeQuality quality = shape_quality(mesh.positions, triangulate(mesh));
  fmt::print(
      "{}: {} vertices, {} faces, edges {:.1f} to {:.1f} mm (median {:.1f}), smallest angle {:.0f} degrees (1 % below "
      "{:.0f}), {:.1f} mm from the body at least{}\n",
      arguments.out, mesh.vertex_count(), mesh.face_count(), 1e3 * quality.shortest_edge, 1e3 * quality.longest_edge,
      1e3 * quality.median_edge, quality.smallest_angle_deg, quality.angle_deg_p1, 1e3 * fit.gap,
      garment->moved > 0 ? fmt::format(", moved out by up to {:.1f} mm", 1e3 * garment->moved) : "");
  return 0;
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
  app.add_option("--bind", arguments.request.bind, "pose to model on: t_pose; default the file's");
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

// Units and axes of the file, then its nodes, meshes and clips; and a word on everything in it that is not used.
#include "io/import/fbx/read_fbx.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <new>

#include "io/import/fbx/fbx_clips.h"
#include "io/import/fbx/fbx_contents.h"
#include "io/import/fbx/fbx_document.h"
#include "io/import/fbx/fbx_scene.h"

namespace ft::inline io {
namespace {

Vec3 signed_axis(std::int64_t index, std::int64_t sign) {
  Vec3 v = Vec3::Zero();
  if (index >= 0 && index < 3) v[static_cast<Eigen::Index>(index)] = sign < 0 ? -1 : 1;
  return v;
}

/// Up, front and right of the file become Y, Z and X; a left-handed or nonsensical set keeps only its up axis.
void read_frame(const FbxObject& settings, Character& out) {
  out.file_unit = 0.01 * settings.number("UnitScaleFactor", 1);
  if (!(out.file_unit > 1e-9 && out.file_unit < 1e9)) {
    out.notes.push_back("the file's unit is not a number above 0; centimetres assumed");
    out.file_unit = 0.01;
  }
  const std::int64_t up = settings.integer("UpAxis", 1), up_sign = settings.integer("UpAxisSign", 1);
  const Vec3 up_axis = signed_axis(up, up_sign);
  Mat3 axes;
  axes.row(0) = signed_axis(settings.integer("CoordAxis", 0), settings.integer("CoordAxisSign", 1));
  axes.row(1) = up_axis;
  axes.row(2) = signed_axis(settings.integer("FrontAxis", 2), settings.integer("FrontAxisSign", 1));
  if (axes.determinant() < 0.5) {
    const Vec3 y = up_axis.norm() > 0.5 ? up_axis : Vec3::UnitY().eval();
    axes = Quat::FromTwoVectors(y, Vec3::UnitY()).toRotationMatrix();
    axes = axes.array().round().matrix();
    out.notes.push_back("the file's axes are not right-handed; only its up axis was used");
  }
  out.file_axes = axes;
  const char* names[] = {"x", "y", "z"};
  out.file_up = std::string(up_sign < 0 ? "-" : "") + (up >= 0 && up < 3 ? names[up] : "y");
}

Result<Character> read_document(Bytes data) {
  auto document = FbxDocument::read(data);
  data = Bytes();
  if (!document) return document.error();
  Character out;
  out.format = "FBX";
  read_frame(document->settings(), out);
  auto scene = read_fbx_nodes(*document, out);
  if (!scene) return scene.error();
  if (Status s = read_fbx_meshes(*document, *scene, out); !s) return s.error();
  list_fbx_contents(*document, out);
  scene->models.resize(out.nodes.size(), nullptr);  // nodes that were added for a second mesh are no models
  read_fbx_clips(*document, scene->models, scene->shapes, out);
  return out;
}

}  // namespace

Result<Character> read_fbx(Bytes data) {
  try {
    return read_document(std::move(data));
  } catch (const std::bad_alloc&) {
    return input_error("needs more memory than the import may use");
  }
}

}  // namespace ft::inline io

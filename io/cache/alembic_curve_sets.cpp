#include "io/cache/alembic_curve_sets.h"

#include "io/cache/alembic_view.h"

namespace ft::inline io {
namespace {

using namespace alembic;

/// An archive of one object under its ancestors' transforms, for each object with curves.
class CurveFinder {
 public:
  CurveFinder(const InputFile& file, const Archive& archive) : file_(file), all_(archive) {
    one_.metadata = archive.metadata;
    one_.time_samplings = archive.time_samplings;
  }

  Result<std::vector<CurveObject>> run() {
    if (const Status status = visit(all_.top); !status) return status.error();
    if (found_.empty()) return input_error("holds no curves", file_.path().string());
    return std::move(found_);
  }

 private:
  static const Property* property_of(const Object& object, std::string_view name) {
    for (const Property& p : object.properties)
      if (p.name == name) return &p;
    return nullptr;
  }

  Status visit(const Object& object) {
    const Property* geom = property_of(object, ".geom");
    if (geom != nullptr && object.metadata.find("schema=AbcGeom_Curve_v2") != std::string::npos)
      if (const Status status = add(object, *geom); !status) return status;
    ancestors_.push_back(&object);
    for (const Object& child : object.children)
      if (const Status status = visit(child); !status) return status;
    ancestors_.pop_back();
    return {};
  }

  Status add(const Object& object, const Property& geom) {
    Object tree{object.name, object.metadata, object.properties, {}};
    for (std::size_t i = ancestors_.size(); i-- > 0;) {
      Object above{ancestors_[i]->name, ancestors_[i]->metadata, {}, {}};
      if (const Property* xform = property_of(*ancestors_[i], ".xform")) above.properties.push_back(*xform);
      above.children.push_back(std::move(tree));
      tree = std::move(above);
    }
    one_.top = std::move(tree);
    auto view = find_shape(file_, one_);
    if (!view) return view.error();
    CurveObject& out = found_.emplace_back();
    out.name = object.name;
    out.curves = std::move(view->info.curves);
    const Property* type = geom.find("curveBasisAndType");
    if (type == nullptr || type->samples.empty() || type->pod != Pod::k_u8) return {};
    const auto values = values_of<std::uint8_t>(file_, type->samples.front());
    if (!values) return values.error();
    out.linear = !values->empty() && values->front() == 1;
    return {};
  }

  const InputFile& file_;
  const Archive& all_;
  Archive one_;
  std::vector<const Object*> ancestors_;
  std::vector<CurveObject> found_;
};

}  // namespace

Result<std::vector<CurveObject>> read_alembic_curve_sets(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  std::vector<StoredHashes> hashes;
  const auto archive = parse(*file, &hashes);
  if (!archive) return archive.error();
  if (is_own(*archive) &&
      (hashes.empty() || hashes.front().children != hash_children(archive->top, archive->time_samplings)))
    return input_error("is damaged: its content does not match its hash", path.string());
  return CurveFinder(*file, *archive).run();
}

}  // namespace ft::inline io

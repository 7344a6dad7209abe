#include "baker/run/cache_set.h"

#include <algorithm>

#include "baker/core/file.h"
#include "baker/plan/output_formats.h"
#include "baker/record/bake_folder.h"
#include "baker/record/version.h"
#include "baker/run/cached_shape.h"
#include "baker/run/converted.h"
#include "io/shot/mesh_file.h"
#include "io/shot/weld.h"

namespace ft::inline baker {
namespace {

std::shared_ptr<const Mesh> shared(Mesh mesh) {
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace

CacheSet::CacheSet(const BakePlan& plan, const Solvers& solvers, std::filesystem::path folder,
                   std::vector<ManifestSystem> earlier)
    : plan_(plan), solvers_(solvers), folder_(std::move(folder)), earlier_(std::move(earlier)) {
  CHECK(plan.groups.size() == solvers.size());
  for (std::size_t g = 0; g < solvers.size(); ++g) {
    const Solver& solver = *solvers[g];
    const PrimaryPlan& primary = plan.primaries[plan.groups[g]->primary];
    const auto& outputs = plan.groups[g]->outputs;
    CHECK(outputs.size() == static_cast<std::size_t>(solver.system_count()));
    const std::vector<ColliderSlice>& slices = slices_.emplace_back(plan.groups[g]->slices(plan, names()));
    for (int s = 0; s < solver.system_count(); ++s) {
      const SystemOutput& output = outputs[static_cast<std::size_t>(s)];
      Source source{.group = g, .garment = s, .primary = output.primary};
      source.mesh = output.mesh;
      source.shape = output.shape;
      source.content = output.content();
      source.scalars = output.scalars.empty() ? nullptr : dynamic_cast<const HasScalars*>(&solver);
      CHECK(output.scalars.empty() ||
            (source.scalars && std::ranges::equal(output.scalars, source.scalars->scalar_names(s))));
      const SystemShape* moved = solver.system_shape(s);
      CHECK((moved != nullptr) == (output.shape != nullptr));
      CHECK(!moved || (moved->content == output.content() && moved->instances.ids == output.shape->instances.ids));
      add(std::move(source), output.name(), std::string(plan.groups[g]->role()), true);
      systems_.back().pattern_scale = output.pattern_scale;
      systems_.back().weld = output.weld;
      for (const ColliderSlice& slice : slices)
        if (slice.met_by.empty() || slice.met_by[at(s)] != 0) systems_.back().meets.push_back(slice.name);
    }
    const bool alone = outputs.empty();
    if (!plan.shot().cache_collider && !alone) continue;
    std::vector<Vec3> collider;
    solver.collider_positions(solver.initial_state(), collider);
    for (const ColliderSlice& slice : slices) {
      if (!slice.fixed) add_collider(g, slice, collider);
      add_body(g, slice.primary);
    }
    if (!slices.empty()) continue;
    if (!collider.empty() && plan.groups[g]->has_feasible_collider()) {
      Source source{.group = g, .collider = true, .primary = plan.groups[g]->primary};
      const std::string name = primary.name + ".collider";
      source.mesh = shared(make_triangle_mesh(name, collider, solver.collider_triangles()));
      add(std::move(source), name, "collider", false);
    }
    add_body(g, plan.groups[g]->primary);
  }
}

std::vector<std::string> CacheSet::names() const {
  std::vector<std::string> out;
  for (const auto* list : {&earlier_, &systems_})
    for (const ManifestSystem& system : *list) out.push_back(system.name);
  return out;
}

std::vector<ManifestSystem> CacheSet::systems() const {
  std::vector<ManifestSystem> out = earlier_;
  out.insert(out.end(), systems_.begin(), systems_.end());
  return out;
}

void CacheSet::add_collider(std::size_t group, const ColliderSlice& slice, std::span<const Vec3> collider) {
  std::vector<Vec3> own;
  for (const int v : slice.vertices) own.push_back(collider[at(v)]);
  Source source{.group = group, .collider = true, .primary = slice.primary, .slice = slice.vertices};
  source.mesh = shared(make_triangle_mesh(slice.name, own, slice.triangles));
  add(std::move(source), slice.name, "collider", false);
}

/// The drawn body, unless another group has it. Of a group without outputs it is what the bake is for.
void CacheSet::add_body(std::size_t group, std::size_t primary) {
  const PrimaryPlan& body = plan_.primaries[primary];
  const bool all_formats = std::any_of(plan_.groups.begin(), plan_.groups.end(),
                                       [&](const auto& g) { return g->primary == primary && g->outputs.empty(); });
  const std::vector<std::string> taken = names();
  if (std::find(taken.begin(), taken.end(), body.cache_name()) != taken.end()) return;
  Source source{.group = group, .primary = primary};
  for (std::size_t g = 0; g < solvers_.size(); ++g)
    if (const auto* mover = dynamic_cast<const MovesPrimaries*>(solvers_[g].get()); mover && mover->moves(body.name))
      source.group = g, source.mover = mover;
  source.mesh =
      shared(make_triangle_mesh(body.name, bind_pose_of(*body.trajectory), body.trajectory->surface().triangles));
  add(std::move(source), body.name, "body", all_formats);
  systems_.back().sheet = has_sheets(body.trajectory->surface().parts);
}

void CacheSet::add(Source source, std::string name, const std::string& role, bool all_formats) {
  ManifestSystem system;
  system.name = std::move(name);
  system.role = role;
  system.primary = plan_.primaries[source.primary].name;
  if (source.shape) {
    CHECK(fault_of_prototypes(*source.shape).empty());
    describe_shape(*source.shape, system);
  } else {
    system.vertex_count = source.mesh->vertex_count();
    system.face_count = source.mesh->face_count();
    system.topology = system.name + ".obj";
  }
  system.scalars = source.content.scalars;
  const SystemKind* kind = find_system_kind(role);
  source.flows = kind && kind->is_liquid() && !source.shape;
  for (const CacheFormat* format : formats_for(plan_.shot(), source.content)) {
    system.caches.push_back({std::string(format->name), system.name + std::string(format->extension), 0, {}});
    if (!all_formats) break;
  }
  CHECK(!system.caches.empty());  // the plan has refused it
  sources_.push_back(std::move(source));
  systems_.push_back(std::move(system));
}

CacheInfo CacheSet::info_of(std::size_t system) const {
  CacheInfo info;
  info.system = systems_[system].name;
  if (sources_[system].shape)
    fill_info(*sources_[system].shape, info);
  else
    info.mesh = *sources_[system].mesh, info.content = sources_[system].content;
  info.fps = plan_.shot().fps;
  info.first_frame = plan_.first_written();
  info.frame_count = plan_.written_count();
  info.metadata = {
      {"inputs", plan_.inputs.fingerprint.hex()}, {"program", "followthrough " + program_version()}, {"units", "m"}};
  return info;
}

Status CacheSet::write_rest(std::size_t system) const {
  const std::filesystem::path path = folder_ / systems_[system].topology;
  const Source& source = sources_[system];
  return source.shape ? write_prototypes(path, *source.shape) : write_obj(path, *source.mesh);
}

Status CacheSet::open(int last_kept) {
  CHECK(writers_.empty());
  const int keep_frames = std::max(0, last_kept - plan_.first_written() + 1);
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    if (keep_frames == 0)
      if (const Status written = write_rest(i); !written) return written;
    const CacheInfo info = info_of(i);
    auto& writers = writers_.emplace_back();
    for (const ManifestCache& cache : systems_[i].caches) {
      auto writer = find_cache_format(cache.format)->open_writer(folder_ / cache.file, info, keep_frames);
      if (!writer) return writer.error();
      CHECK((*writer)->frame_count() == keep_frames);
      writers.push_back(std::move(*writer));
    }
    if (const Status opened = open_motion(i, info, std::max(0, last_kept - begin() + 1)); !opened) return opened;
    sources_[i].mesh.reset();
  }
  return {};
}

Status CacheSet::open_motion(std::size_t system, const CacheInfo& info, int keep_frames) {
  motions_.emplace_back(), flows_.emplace_back();
  if (plan_.is_last_stage() || sources_[system].garment < 0 || sources_[system].shape) return {};
  CacheInfo all = info;
  all.content.scalars.clear();
  all.first_frame = begin();
  all.frame_count = plan_.shot().last_frame - begin() + 1;
  const auto record = [&](const std::filesystem::path& path, std::unique_ptr<CacheWriter>& out) -> Status {
    auto writer = find_cache_format("pc2")->open_writer(path, all, keep_frames);
    if (!writer) return writer.error();
    out = std::move(*writer);
    return {};
  };
  const BakeFolder folder{folder_};
  if (const Status opened = record(folder.motion(info.system), motions_.back()); !opened) return opened;
  if (!sources_[system].flows) return {};
  return record(folder.flow(info.system), flows_.back());
}

void CacheSet::positions_of(const Source& source, const State& state, std::span<Vec3> x) const {
  const Solver& solver = *solvers_[source.group];
  const auto& joined_of = plan_.groups[source.group]->outputs[static_cast<std::size_t>(source.garment)].joined_of;
  if (joined_of.empty()) return solver.system_positions(state, source.garment, x);
  std::vector<Vec3> joined(static_cast<std::size_t>(solver.system_mesh(source.garment).vertex_count()));
  solver.system_positions(state, source.garment, joined);
  spread_welded(joined_of, joined, x);
}

void CacheSet::slice_of(const Source& source, const State& state, std::span<Vec3> x) const {
  std::vector<Vec3> all;
  solvers_[source.group]->collider_positions(state, all);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = all[at(source.slice[i])];
}

std::vector<AbsentRuns> CacheSet::as_cached(std::size_t group, std::vector<AbsentRuns> absent) const {
  if (slices_[group].empty()) return absent;
  std::vector<AbsentRuns> out;
  for (const AbsentRuns& runs : absent)
    for (AbsentRuns& own : sliced(runs, slices_[group])) out.push_back(std::move(own));
  return out;
}

std::vector<Vec3> CacheSet::positions_of_mesh(std::size_t system, const State& state) const {
  const Source& source = sources_[system];
  std::vector<Vec3> x(static_cast<std::size_t>(systems_[system].vertex_count));
  if (source.garment >= 0)
    positions_of(source, state, x);
  else if (!source.slice.empty())
    slice_of(source, state, x);
  else if (source.mover)
    source.mover->moved_positions(state, plan_.primaries[source.primary].name, x);
  else if (source.collider ||
           (source.primary == plan_.groups[source.group]->primary && solvers_[source.group]->moves_primary()))
    solvers_[source.group]->collider_positions(state, x);
  else
    plan_.primaries[source.primary].trajectory->sample(state.time, x);
  return x;
}

Snapshot CacheSet::take(std::span<const State> states) const {
  Snapshot out;
  out.frame = states.empty() ? 0 : states[0].frame;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    const State& state = states[source.group];
    FrameData& frame = out.systems.emplace_back();
    if (source.shape)
      solvers_[source.group]->system_frame(state, source.garment, frame);
    else
      frame.positions = converted<Vec3f, Vec3>(positions_of_mesh(i, state));
    if (source.scalars) source.scalars->system_scalars(state, source.garment, frame.scalars);
    if (source.flows) {
      std::vector<Vec3> flow(frame.positions.size(), Vec3::Zero());
      solvers_[source.group]->surface_flow(state, source.garment, flow);
      frame.velocities = converted<Vec3f, Vec3>(flow);
    }
  }
  return out;
}

Status CacheSet::write(const Snapshot& snapshot, const Snapshot* before, const Snapshot* after) {
  const auto positions_in = [](const Snapshot* other, std::size_t system) {
    return other != nullptr ? std::span<const Vec3f>(other->systems[system].positions) : std::span<const Vec3f>();
  };
  for (std::size_t i = 0; i < writers_.size(); ++i) {
    const bool is_cached = snapshot.frame >= plan_.first_written();
    if (!is_cached && !motions_[i]) continue;
    if (sources_[i].shape) {
      for (auto& writer : writers_[i])
        if (const Status written = writer->write_frame(snapshot.systems[i].view()); !written) return written;
      continue;
    }
    const std::vector<Vec3> x = converted<Vec3, Vec3f>(snapshot.systems[i].positions);
    if (motions_[i])
      if (const Status written = motions_[i]->write_frame(x, {}); !written) return written;
    if (flows_[i])
      if (const Status written = flows_[i]->write_frame(converted<Vec3, Vec3f>(snapshot.systems[i].velocities), {});
          !written)
        return written;
    if (!is_cached) continue;
    std::vector<Vec3> v;
    if (has_differences(i))
      v = velocities_of(sources_[i], snapshot.frame, x, positions_in(before, i), positions_in(after, i));
    for (std::size_t k = 0; sources_[i].flows && k < v.size(); ++k)
      v[k] += snapshot.systems[i].velocities[k].cast<double>();
    for (auto& writer : writers_[i])
      if (const Status written = writer->write_frame(x, v, snapshot.systems[i].scalars); !written) return written;
  }
  return {};
}

Status CacheSet::close() {
  for (auto& writers : writers_)
    for (auto& writer : writers)
      if (const Status closed = writer->close(); !closed) return closed;
  for (auto* records : {&motions_, &flows_})
    for (auto& record : *records)
      if (record)
        if (const Status closed = record->close(); !closed) return closed;
  writers_.clear();
  motions_.clear(), flows_.clear();
  for (ManifestSystem& system : systems_)
    for (ManifestCache& cache : system.caches) {
      const auto content = hash_file(folder_ / cache.file);
      if (!content)
        return output_error("cannot read back what was written: " + content.error().what, content.error().where);
      cache.bytes = content->bytes;
      cache.content = content->hash.hex();
    }
  return {};
}

std::uint64_t CacheSet::expected_bytes() const {
  std::uint64_t sum = 0;
  const auto frames = static_cast<std::uint64_t>(std::max(0, plan_.written_count()));
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const ManifestSystem& system = systems_[i];
    FrameContent content = sources_[i].content;
    if (!sources_[i].shape) content.velocities = is_secondary(system.role);
    const FrameCounts counts{.elements = static_cast<std::uint64_t>(system.vertex_count + system.count)};
    for (const ManifestCache& cache : system.caches)
      sum += frames * find_cache_format(cache.format)->bytes_per_frame(content, counts);
  }
  return sum;
}

}  // namespace ft::inline baker

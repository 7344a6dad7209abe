// `check` judges what was baked: joined where the shot's `weld` joins, split into the triangles that were simulated,
// and never a part for the whole.
#include <gtest/gtest.h>

#include <csignal>

#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "collision/check/crossings.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "io/shot/weld.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

/// Two panels of quads whose edges lie on each other at z = 0.5, bent so that their quads are not flat. The last column
/// of the second panel (15, 19, 23) is the first of the first (0, 4, 8).
Mesh two_panels() {
  Mesh out;
  for (const double begin : {0.5, 0.0})
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        const double z = begin + 0.5 * i / 3, y = 0.4 * j;
        out.positions.emplace_back(1.2 + 0.1 * std::sin(7 * z + 5 * y) + 0.05 * std::cos(9 * z * y), y, z);
      }
  for (const int first : {0, 12})
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) {
        const int a = first + 4 * j + i;
        out.face_sizes.push_back(4);
        for (const int v : {a, a + 1, a + 5, a + 4}) out.face_vertices.push_back(v);
      }
  return out;
}

BakeResult bake_for_real(const FakeScene& scene) {
  BakeServices services = scene.services();
  services.make_solver = make_group_solver;
  Progress silent;
  return bake(scene.options(), services, silent);
}

TEST(CheckAsBaked, Seams_that_weld_closes_are_no_crossings) {
  FakeScene scene;
  scene.write_garment(two_panels());
  scene.write_shot(4, "weld = 1e-4");
  const BakeResult baked = scene.run();
  ASSERT_EQ(baked.exit_code, 0) << text(baked);
  const auto apart = read_obj(scene.folder().path / "sheet.obj");
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->vertex_count(), two_panels().vertex_count());
  EXPECT_FALSE(crossings_within(apart->positions, triangulate(*apart)).empty());  // as the file has them
  const auto judged = judge_caches(scene.folder().path);
  ASSERT_TRUE(judged) << judged.error().text();
  ASSERT_EQ(judged->frames.size(), 4u);
  for (const FrameReport& f : judged->frames) EXPECT_EQ(f.crossings_self, 0) << f.frame;
}

TEST(CheckAsBaked, Strain_of_a_welded_cloth_of_bent_quads_is_that_of_the_manifest) {
  FakeScene scene;
  scene.write_garment(two_panels());
  for (const char* faces : {"file", "triangles"}) {
    scene.write_shot(3, std::string("weld = 1e-4\npins = [{ vertices = \"0-3\" }]\nfaces = \"") + faces + "\"");
    const BakeResult baked = bake_for_real(scene);
    ASSERT_EQ(baked.exit_code, 0) << text(baked);
    const auto manifest = read_manifest(scene.folder().path);
    ASSERT_TRUE(manifest) << manifest.error().text();
    EXPECT_EQ(manifest->systems.at(0).weld, 1e-4);
    const auto judged = judge_caches(scene.folder().path);
    ASSERT_TRUE(judged) << judged.error().text();
    const std::size_t preroll = manifest->frames.size() - judged->frames.size();
    for (std::size_t i = 0; i < judged->frames.size(); ++i) {
      const FrameReport &theirs = manifest->frames[preroll + i], &ours = judged->frames[i];
      EXPECT_GT(ours.strain_max, 1e-4);
      EXPECT_NEAR(ours.strain_max, theirs.strain_max, 1e-5);  // caches hold floats
      EXPECT_NEAR(ours.strain_mean, theirs.strain_mean, 1e-5);
      EXPECT_EQ(ours.crossings_self, theirs.crossings_self);
    }
  }
}

TEST(CheckAsBaked, Caches_have_the_faces_of_the_file_or_the_triangles_that_were_simulated) {
  FakeScene scene;
  const Mesh given = two_panels();
  scene.write_garment(given);
  for (const bool welded : {false, true}) {
    const std::string weld_line = welded ? "weld = 1e-4\n" : "offset = [0, 0, 0]\n";
    if (!welded)
      scene.write_garment([&] {  // without weld the panels have to be apart
        Mesh apart = given;
        for (std::size_t v = 12; v < 24; ++v) apart.positions[v].z() -= 0.1;
        return apart;
      }());
    if (welded) scene.write_garment(given);
    scene.write_shot(1, weld_line);
    ASSERT_EQ(scene.run().exit_code, 0);
    const auto file = read_obj(scene.folder().path / "sheet.obj");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->face_sizes, given.face_sizes);
    EXPECT_EQ(file->face_vertices, given.face_vertices);

    scene.write_shot(1, weld_line + "faces = \"triangles\"");
    ASSERT_EQ(scene.run().exit_code, 0);
    const auto split = read_obj(scene.folder().path / "sheet.obj");
    ASSERT_TRUE(split);
    EXPECT_EQ(split->positions, file->positions);
    EXPECT_EQ(split->face_count(), 2 * given.face_count());
    const Mesh simulated = welded ? weld(*file, 1e-4).mesh : *file;
    const std::vector<Triangle> wanted = triangulate(simulated);
    std::vector<Triangle> got = triangulate(*split);
    if (welded)
      for (Triangle& t : got)
        for (int& v : t) v = weld(*file, 1e-4).joined_of[at(v)];
    EXPECT_EQ(got, wanted);
    const auto manifest = read_manifest(scene.folder().path);
    ASSERT_TRUE(manifest);
    EXPECT_EQ(manifest->systems.at(0).face_count, split->face_count());
    const auto abc = open_cache(scene.folder().path / "sheet.abc");
    ASSERT_TRUE(abc) << abc.error().text();
    EXPECT_EQ((*abc)->info().mesh.face_vertices, split->face_vertices);
  }
}

TEST(CheckAsBaked, A_crossing_is_told_of_by_the_vertex_of_the_file) {
  FakeScene scene;
  Mesh folded = two_panels();
  for (int v = 0; v < 12; ++v) folded.positions[at(v)] += Vec3(1, 0, 0);
  const int first = folded.vertex_count();  // a copy of the first panel, turned through it
  for (int v = 12; v < 24; ++v) {
    const Vec3 p = folded.positions[at(v)];
    folded.positions.emplace_back(p.x(), p.z() + 0.1, p.y() - 0.3);
  }
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i) {
      const int a = first + 4 * j + i;
      folded.face_sizes.push_back(4);
      for (const int v : {a, a + 1, a + 5, a + 4}) folded.face_vertices.push_back(v);
    }
  folded.positions.insert(folded.positions.begin(), folded.positions[0]);  // vertex 1 joins vertex 0: numbers shift
  for (int& v : folded.face_vertices) ++v;
  scene.write_garment(folded);
  scene.write_shot(1, "weld = 1e-4");
  const BakeResult baked = scene.run();
  ASSERT_EQ(baked.exit_code, 0) << text(baked);
  const auto judged = judge_caches(scene.folder().path);
  ASSERT_TRUE(judged) << judged.error().text();
  const auto abc = open_cache(scene.folder().path / "sheet.abc");
  ASSERT_TRUE(abc);
  std::vector<Vec3f> x;
  ASSERT_TRUE((*abc)->read_frame(0, x).ok());
  ASSERT_FALSE(judged->frames.at(0).incidents.empty());
  const Incident& incident = judged->frames[0].incidents[0];
  EXPECT_GT(judged->frames[0].crossings_self, 0);
  EXPECT_EQ(incident.place, x[at(incident.vertex)].cast<double>());
}

TEST(CheckAsBaked, Incidents_of_the_manifest_have_the_numbers_of_the_file) {
  FakeScene scene;
  Mesh panels = two_panels();
  scene.write_garment(panels);
  scene.write_shot(2, "weld = 1e-4");
  FakeBehaviour behaviour;
  behaviour.after_frame = [](int frame, FrameReport& report, State&) {
    Incident incident;
    incident.frame = frame;
    incident.system = "sheet";
    incident.vertex = 12;  // of the joined mesh: the second panel's first vertex is the file's twelfth, its last joins
    report.incidents.push_back(incident);
    incident.vertex = 15;  // 15 of the file is 3 again: the next that is not joined
    report.incidents.push_back(incident);
    incident.system = "another";
    report.incidents.push_back(incident);
  };
  ASSERT_EQ(scene.run(scene.options(), behaviour).exit_code, 0);
  const auto manifest = read_manifest(scene.folder().path);
  ASSERT_TRUE(manifest) << manifest.error().text();
  const auto& incidents = manifest->frames.back().incidents;
  ASSERT_EQ(incidents.size(), 3u);
  EXPECT_EQ(incidents[0].vertex, 12);
  EXPECT_EQ(incidents[1].vertex, 16);
  EXPECT_EQ(incidents[2].vertex, 15);
}

TEST(CheckAsBaked, Of_a_bake_that_was_interrupted_the_missing_frames_are_counted) {
  FakeScene scene;
  for (const int last : {-1, 0, 4, 9}) {
    RecordedProgress progress;
    progress.on_frame = [&](int frame) { frame == last ? void(std::raise(SIGINT)) : void(); };
    BakeOptions options = scene.options();
    options.force = true;
    ASSERT_EQ(bake(options, scene.services(), progress).exit_code, 130);
    const auto judged = judge_caches(scene.folder().path);
    ASSERT_TRUE(judged) << judged.error().text();
    EXPECT_FALSE(judged->complete);
    EXPECT_EQ(judged->frame_count, 10);
    EXPECT_EQ(judged->missing_frames, 10 - std::max(0, last)) << last;
    EXPECT_EQ(judged->frames.size(), at(std::max(0, last)));
  }
  for (const char* cache : {"sheet.abc", "box.abc"}) {
    std::filesystem::remove(scene.folder().path / cache);
    const auto judged = judge_caches(scene.folder().path);
    ASSERT_TRUE(judged) << judged.error().text();
    EXPECT_EQ(judged->missing_frames, 10) << cache;
  }
}

}  // namespace
}  // namespace ft::test

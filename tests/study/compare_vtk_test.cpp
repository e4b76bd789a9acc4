// Runs compared: surfaces of snapshots, distances of surfaces, energy norm.
#include "core/errors.hpp"
#include "measure/energy_norm.hpp"
#include "measure/surface_distance.hpp"
#include "record/mesh_writer.hpp"
#include "study/compare.hpp"
#include "study/frame_surface.hpp"
#include "support/own_folder.hpp"
#include "support/tissues.hpp"

namespace {

namespace fs = std::filesystem;

class CompareTest : public OwnFolder {
 protected:
  /// A run with one frame: the block displaced by `displacements` from rest.
  [[nodiscard]] ReferenceRun run_with(const std::string& name, const Vectors& displacements,
                                      const std::string& scenario) const {
    fs::create_directories(folder / name / "frames");
    Vectors positions = block.rest_positions;
    for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += displacements[n];
    MeshArrays arrays;
    arrays.node_vectors = {{"displacement_um", displacements}};
    write_mesh(folder / name / "frames/frame_00000.vtu", block, positions, arrays, 7);
    write_collection(folder / name / "frames.pvd", {{7, "frames/frame_00000.vtu"}});
    std::ofstream(folder / name / "scenario.toml") << scenario;
    return ReferenceRun(folder / name);
  }

  const Tissue block = distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 2, 9);
};

// Displacements as large as cells, so that shapes at rest and shapes now have different stiffness.
TEST_F(CompareTest, EnergyNormIsThatOfTheMeshAtRestAndOfTheScenariosPoissonRatio) {
  Random random(3);
  const Vectors u_a = random.vectors(block.node_count(), 6), u_b = random.vectors(block.node_count(), 6);
  const ReferenceRun a = run_with("a", u_a, ""), b = run_with("b", u_b, "[elasticity]\npoisson_ratio = 0.2\n");
  const auto found = compare_runs(a, a.last_frame(), b, b.last_frame());
  const RestMesh rest{block.elements, block.element_rest_shape, {}};
  const double expected = relative_energy_norm(rest, 0.2, u_a, u_b).value();
  EXPECT_NEAR(found.at("relative_energy_norm").get<double>(), expected, 1e-9 * expected);
  EXPECT_GT(std::abs(relative_energy_norm(rest, 0.45, u_a, u_b).value() / expected - 1), 1e-3);

  double sum = 0, squares = 0, largest = 0;
  for (std::size_t n = 0; n < u_a.size(); ++n) {
    sum += (u_a[n] - u_b[n]).norm(), squares += (u_a[n] - u_b[n]).squaredNorm();
    largest = std::max(largest, (u_a[n] - u_b[n]).norm());
  }
  EXPECT_NEAR(found.at("nodes").at("mean_um").get<double>(), sum / static_cast<double>(u_a.size()), 1e-9);
  EXPECT_NEAR(found.at("nodes").at("rms_um").get<double>(), std::sqrt(squares / static_cast<double>(u_a.size())), 1e-9);
  EXPECT_NEAR(found.at("nodes").at("max_um").get<double>(), largest, 1e-9);
  const std::size_t farthest = found.at("nodes").at("farthest_node");
  EXPECT_NEAR((u_a[farthest] - u_b[farthest]).norm(), largest, 1e-9);
}

TEST_F(CompareTest, AScenarioThatIsNotUnderstoodLeavesTheEnergyNormOut) {
  const Vectors u(block.node_count(), Vec3(1, 0, 0));
  const ReferenceRun run = run_with("a", u, "[elasticity]\npoisson = 0.2\n");
  const auto found = compare_runs(run, run.last_frame(), run, run.last_frame());
  EXPECT_TRUE(found.at("relative_energy_norm").is_null());
  EXPECT_EQ(found.at("nodes").at("max_um"), 0);
}

TEST_F(CompareTest, VolumesOfInvertedElementsAreNegative) {
  Vectors mirrored = block.rest_positions;
  for (Vec3& x : mirrored) x = Vec3(0, 0, -2 * x.z());  // z to -z
  const ReferenceRun a = run_with("a", mirrored, ""), b = run_with("b", Vectors(block.node_count(), Vec3::Zero()), "");
  const auto found = compare_runs(a, a.last_frame(), b, b.last_frame());
  const double volume_a = found.at("geometry").at("volume_um3").at("a"),
               volume_b = found["geometry"]["volume_um3"]["b"];
  EXPECT_GT(volume_b, 0);
  EXPECT_NEAR(volume_a, -volume_b, 1e-6);
}

TEST_F(CompareTest, FramesByTime) {
  const ReferenceRun run = run_with("a", Vectors(block.node_count(), Vec3::Zero()), "");
  EXPECT_EQ(frame_to_compare(run, {}).time_s, 7);
  EXPECT_EQ(frame_to_compare(run, 7 + 1e-9).time_s, 7);
  EXPECT_THROW((void)frame_to_compare(run, 6.9), UsageError);
}

Frame frame_of(const Tissue& tissue) {
  Frame frame;
  frame.positions = tissue.rest_positions;
  frame.elements = tissue.elements;
  return frame;
}

Frame block(std::array<int, 3> elements_per_cell = {1, 1, 1}) {
  return frame_of(build_block({.length_um = 60,
                               .width_um = 40,
                               .cell_height_um = 40,
                               .cells = {3, 2, 1},
                               .elements_per_cell = elements_per_cell}));
}

Frame shifted(Frame frame, const Vec3& by) {
  for (Vec3& x : frame.positions) x += by;
  return frame;
}

Distances between(const Frame& a, const Frame& b) {
  return distances_to(SurfaceDistance(fine_triangles(b, apical_facets(b))), a, apical_facets(a));
}

TEST(FrameSurface, FacetsAreThoseOfTheOutermostElements) {
  for (const int layers : {1, 2}) {
    const Frame frame = block({2, 1, layers});
    EXPECT_EQ(apical_facets(frame).size(), 12U);
    EXPECT_EQ(basal_facets(frame).size(), 12U);
    EXPECT_NEAR(total_area(frame, apical_facets(frame)), 2400, 1e-9);
    double highest = -1e300;
    for (const Vec3& x : frame.positions) highest = std::max(highest, x.z());
    for (const auto& facet : apical_facets(frame))
      for (const NodeId node : facet) EXPECT_EQ(frame.positions[node.index()].z(), highest);
  }
}

TEST(FrameSurface, TrianglesCoverFlatFacetsAndStayNearTwistedOnes) {
  const Frame flat = block();
  const TriangleSurface triangles = fine_triangles(flat, apical_facets(flat));
  EXPECT_EQ(triangles.triangles.size(), 6U * 256);
  double area = 0;
  for (const auto& [a, b, c] : triangles.triangles)
    area += (triangles.points[b] - triangles.points[a]).cross(triangles.points[c] - triangles.points[a]).norm() / 2;
  EXPECT_NEAR(area, 2400, 1e-9);
  EXPECT_EQ(facet_error(flat, apical_facets(flat)), 0);

  // One facet with a corner lifted by 16 um: z = 16 u v.
  Frame twisted = frame_of(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  const auto facet = apical_facets(twisted).at(0);
  twisted.positions[facet[2].index()].z() += 16;
  EXPECT_NEAR(facet_error(twisted, apical_facets(twisted)), 16.0 / 1024, 1e-12);
  const SurfaceDistance distance(fine_triangles(twisted, apical_facets(twisted)));
  const Vec3 origin = twisted.positions[facet[0].index()];
  const Vec3 u = twisted.positions[facet[1].index()] - origin, v = twisted.positions[facet[3].index()] - origin;
  double farthest = 0;
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j) {
      const double s = i / 64.0, t = j / 64.0;
      farthest = std::max(farthest, distance.from(origin + s * u + t * v + Vec3(0, 0, 16 * s * t)));
    }
  EXPECT_LE(farthest, 16.0 / 1024);
  EXPECT_GE(farthest, 0.3 * 16 / 1024) << "the bound is not idle";
}

TEST(FrameSurface, OfItselfAndOfAShiftedSurface) {
  const Frame frame = frame_of(distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 3, 5));
  EXPECT_LE(between(frame, frame).max, 1e-12);
  const Frame flat = block();
  const Distances up = between(flat, shifted(flat, {0, 0, 5}));
  for (const double value : {up.mean, up.rms, up.max}) EXPECT_NEAR(value, 5, 1e-12);
  // Along x, only the strip of 6 of 60 um that sticks out lies away, by 0 to 6 um; the last facet has 4 samples in x,
  // at 2.5, 7.5, ... um from its end: one of 12 columns, 3.5 um away.
  const Distances along = between(flat, shifted(flat, {6, 0, 0}));
  EXPECT_NEAR(along.max, 6, 1e-12);
  EXPECT_NEAR(along.mean, 3.5 / 12, 1e-12);
  EXPECT_NEAR(along.rms, 3.5 / std::sqrt(12.0), 1e-12);
}

// A plane against a wave of height 1 um over it: mean 2/pi, root mean square 1/sqrt(2), one side nearly as the other.
TEST(FrameSurface, OfDifferentMeshes) {
  const Frame coarse = block();
  Frame wave = block({20, 1, 1});
  for (const auto& facet : apical_facets(wave))
    for (const NodeId node : facet) {
      Vec3& x = wave.positions[node.index()];
      x.z() = coarse.positions[apical_facets(coarse)[0][0].index()].z() + std::sin(2 * std::numbers::pi * x.x() / 60);
    }
  const Distances distances = between(wave, coarse);
  EXPECT_NEAR(distances.mean, 2 / std::numbers::pi, 0.01);
  EXPECT_NEAR(distances.rms, 1 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(distances.max, 1, 0.01);
  EXPECT_NEAR(between(coarse, wave).mean, 2 / std::numbers::pi, 0.01);
}

TEST(FrameSurface, NodesLieAwayFromTheirOwnSide) {
  const Frame frame = block({1, 1, 2});
  Frame other = frame;
  double middle = 0;
  for (const Vec3& x : frame.positions) middle += x.z() / static_cast<double>(frame.positions.size());
  for (Vec3& x : other.positions) x.z() += x.z() > middle + 1 ? 6 : 2;
  const std::vector<double> distances = node_distances(frame, other);
  int inner = 0;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    const double height = frame.positions[n].z() - middle;
    if (std::abs(height) < 1) ++inner;
    EXPECT_NEAR(distances[n], height > 1 ? 6 : height < -1 ? 2 : 4, 1e-12) << "between them, the mean";
  }
  EXPECT_EQ(inner, 12);
}

/// Distance to a triangle the long way: to its plane where the foot lies inside, else to its edges.
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Vec3& from, const Vec3& to) { return normal.cross(to - from).dot(p - from) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.dot(p - a));
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const double part = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (p - from - part * (to - from)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(SurfaceDistance, IsThatOfTheNearestTriangle) {
  Random random(11);
  TriangleSurface surface;
  surface.points = random.vectors(300, 100);
  for (int t = 0; t < 100; ++t) surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  const SurfaceDistance distance(surface);
  for (const double size : {50.0, 150.0, 1000.0})  // among, beside and far from them
    for (int i = 0; i < 300; ++i) {
      const Vec3 point = random.vector(size);
      double nearest = 1e300;
      for (const auto& [a, b, c] : surface.triangles)
        nearest = std::min(nearest, to_triangle(point, surface.points[a], surface.points[b], surface.points[c]));
      ASSERT_NEAR(distance.from(point), nearest, 1e-9) << point.transpose();
    }
  for (const Vec3& point : surface.points) EXPECT_LE(distance.from(point), 1e-12);
}

TEST(SurfaceDistance, ToASingleFlatTriangle) {
  const SurfaceDistance distance({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  EXPECT_NEAR(distance.from({0.2, 0.2, 3}), 3, 1e-12);
  EXPECT_NEAR(distance.from({0.2, 0.2, -3}), 3, 1e-12);
  EXPECT_NEAR(distance.from({4, 0, 4}), 5, 1e-12);
}

// Else a child process that starts meanwhile may wait for a lock that only its parent's thread could open. (Threads
// that tests before this one have started are counted too; the suite runs each test in a process of its own.)
TEST(SurfaceDistance, StartsNoThreads) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  Random random(12);
  TriangleSurface surface;
  surface.points = random.vectors(3000, 100);
  for (int t = 0; t < 1000; ++t) surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  EXPECT_GT(SurfaceDistance(surface).from({1000, 0, 0}), 0);
  EXPECT_EQ(threads(), before);
}

}  // namespace

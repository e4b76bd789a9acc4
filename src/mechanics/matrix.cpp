#include "mechanics/matrix.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

using Mat2 = MembranePoint::Mat2;

std::vector<Facet> bonded_faces(const Tissue& tissue, CellSide side, const CellPattern& pattern) {
  std::vector<Facet> faces = tissue.facets(side);
  std::erase_if(faces, [&](const Facet& face) { return !pattern.cells[face.cell.index()]; });
  return faces;
}

// Chunks of faces, each as an element that lists the corners of the face twice.
ElementChunks face_chunks(const Tissue& tissue, const std::vector<Facet>& faces) {
  std::vector<std::array<NodeId, 8>> corners;
  for (const Facet& face : faces) {
    const auto& n = face.nodes;
    corners.push_back({n[0], n[1], n[2], n[3], n[0], n[1], n[2], n[3]});
  }
  return {tissue, corners};
}

// Derivatives of shape functions by s and t, at (s, t) = (+-1, +-1)/sqrt(3).
const Eigen::Matrix<double, 4, 2>& shape_gradients(int point) {
  static const std::array<Eigen::Matrix<double, 4, 2>, 4> gradients = [] {
    constexpr std::array<std::array<double, 2>, 4> signs = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    std::array<Eigen::Matrix<double, 4, 2>, 4> of_point;
    for (int g = 0; g < 4; ++g)
      for (int i = 0; i < 4; ++i) {
        const auto [s, t] = signs[i];
        of_point[g].row(i) << s / 4 * (1 + t * signs[g][1] / std::sqrt(3)),
            t / 4 * (1 + s * signs[g][0] / std::sqrt(3));
      }
    return of_point;
  }();
  return gradients[static_cast<std::size_t>(point)];
}

Vec3 place_of(const Eigen::Matrix<double, 3, 4>& x, int point) {
  const double near = (1 + 1 / std::sqrt(3)) / 2, far = 1 - near;
  Vec3 place = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    const int apart = (i - point + 4) % 4;
    place += (apart == 0 ? near * near : apart == 2 ? far * far : near * far) * x.col(i);
  }
  return place;
}

Mat2 symmetric(const double* numbers) {
  Mat2 result;
  result << numbers[0], numbers[2], numbers[2], numbers[1];
  return result;
}

void put(const Mat2& symmetric, double* numbers) {
  numbers[0] = symmetric(0, 0), numbers[1] = symmetric(1, 1), numbers[2] = symmetric(0, 1);
}

Mat2 positive_part(const Mat2& stress) {
  Eigen::SelfAdjointEigenSolver<Mat2> axes;
  axes.computeDirect(stress);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.eigenvectors().transpose();
}

// Rotation-free map from the coordinates of one face to those of another: tangents of the other in the plane of the
// first, as combinations of its tangents.
Mat2 map_between(const Eigen::Matrix<double, 3, 2>& from, const Eigen::Matrix<double, 3, 2>& to) {
  const Vec3 n = from.col(0).cross(from.col(1)), other = to.col(0).cross(to.col(1));
  const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(other, n).toRotationMatrix();
  return (from.transpose() * from).inverse() * from.transpose() * turn * to;
}

}  // namespace

MatrixLayer::MatrixLayer(const Tissue& tissue, CellPattern pattern, MatrixRule rule)
    : rule_(std::move(rule)),
      pattern_(std::move(pattern)),
      followed_(tissue, rule_.follow),
      faces_(bonded_faces(tissue, rule_.side, pattern_)),
      chunks_(face_chunks(tissue, faces_)) {}

MatrixLayer::Corners MatrixLayer::corners(std::span<const Vec3> vectors, const Facet& face) {
  Corners x;
  for (int i = 0; i < 4; ++i) x.col(i) = vectors[face.nodes[i].index()];
  return x;
}

MatrixLayer::Tangents MatrixLayer::tangents(const Corners& x, int point) { return x * shape_gradients(point); }

void MatrixLayer::add_transposed(const Tangents& of_tangents, int point, Corners& of_corners) {
  of_corners += of_tangents * shape_gradients(point).transpose();
}

void MatrixLayer::add(const Facet& face, const Corners& of_corners, std::span<Vec3> vectors) {
  for (int i = 0; i < 4; ++i) vectors[face.nodes[i].index()] += of_corners.col(i);
}

MembranePoint MatrixLayer::point(const Place& at, const Tangents& A, const Step& step, double stiffness) const {
  const double* numbers = &step.internal[first_number(at)];
  Mat2 before = symmetric(numbers);
  if (flows()) before = step.extrapolated(before, symmetric(numbers + 4));
  return {before, A.transpose() * A, stiffness * numbers[3], flows() ? step.rate_s / rule_.relaxation_s : 0};
}

double MatrixLayer::energy_of(std::size_t f, const Step& step, double stiffness) const {
  const Corners x = corners(step.positions, faces_[f]);
  double sum = 0;
  for (int g = 0; g < 4; ++g) sum += point({f, g}, tangents(x, g), step, stiffness).energy();
  return sum;
}

MatrixLayer::Corners MatrixLayer::forces_of(std::size_t f, const Step& step, double stiffness) const {
  const Corners x = corners(step.positions, faces_[f]);
  Corners forces = Corners::Zero();
  for (int g = 0; g < 4; ++g) {
    const Tangents A = tangents(x, g);
    add_transposed(-A * point({f, g}, A, step, stiffness).stress(), g, forces);
  }
  return forces;
}

double MatrixLayer::energy(const Step& step) const {
  return chunks_.sum_over_elements([&](std::size_t f) { return energy_of(f, step, stiffness_of(f, step)); });
}

const LawDerivatives& MatrixLayer::derivatives() const {
  if (followed_.is_used()) refuse_gradient("a layer that follows a signal has no gradient; remove follow");
  return *this;
}

void MatrixLayer::add_forces(const Step& step, std::span<Vec3> forces) const {
  chunks_.for_elements([&](std::size_t f) { add(faces_[f], forces_of(f, step, stiffness_of(f, step)), forces); });
}

// Responses to unit programs. A rising program supplies energy; a falling one dissipates what it releases. What the
// forces of a relaxing layer do not store of their work is dissipated, too.
EnergyFlow MatrixLayer::energy_flow(const CompletedStep& completed) const {
  std::vector<EnergyFlow> flows_of(faces_.size());
  chunks_.for_elements([&](std::size_t f) {
    const auto [begin, end, motion] = completed;
    const CellId cell = faces_[f].cell;
    const double from = rule_.program.at(begin.end_time_s) * followed_.before(followed(begin.internal), cell),
                 to = rule_.program.at(end.end_time_s) * followed_.at(followed(begin.internal), cell);
    const double unit = rule_.stiffness * pattern_.strengths[cell.index()];
    const double before = energy_of(f, begin, unit), after = energy_of(f, end, unit);
    const double programmed = (to - from) * 0.5 * (before + after);
    flows_of[f] = {.active = std::max(0.0, programmed),
                   .stored = to * after - from * before,
                   .dissipated = std::max(0.0, -programmed)};
    if (!flows()) return;
    const Corners moved = corners(end.positions, faces_[f]) - corners(begin.positions, faces_[f]);
    const Corners forces = 0.5 * (forces_of(f, begin, unit) + forces_of(f, end, unit));
    flows_of[f].dissipated += 0.5 * (from + to) * (-forces.cwiseProduct(moved).sum() - (after - before));
  });
  EnergyFlow sum;
  for (const EnergyFlow& flow : flows_of) sum += flow;
  return sum;
}

std::pair<MembranePoint, Mat2> MatrixLayer::tangent_point(const Place& at, const Tangents& A, const Step& step,
                                                          double stiffness) const {
  const MembranePoint whole = point(at, A, step, stiffness);
  if (!step.semidefinite_tangent) return {whole, whole.stress()};
  return {whole.relaxed(), positive_part(whole.stress())};
}

// The force A S changes by dA S + A dS, with dC = A^T dA + dA^T A.
void MatrixLayer::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  chunks_.for_elements([&](std::size_t f) {
    const Corners x = corners(step.positions, faces_[f]), dx = corners(direction, faces_[f]);
    const double stiffness = stiffness_of(f, step);
    Corners of_corners = Corners::Zero();
    for (int g = 0; g < 4; ++g) {
      const Tangents A = tangents(x, g), dA = tangents(dx, g);
      const auto [at, stress] = tangent_point({f, g}, A, step, stiffness);
      const Mat2 half = A.transpose() * dA;
      add_transposed(dA * stress + A * at.stress_change(half + half.transpose()), g, of_corners);
    }
    add(faces_[f], of_corners, product);
  });
}

// Strains are E_11, E_22 and 2 E_12, with C = 2 E + 1.
Eigen::Matrix<double, 12, 12> MatrixLayer::tangent_of(std::size_t f, const Step& step) const {
  const Corners x = corners(step.positions, faces_[f]);
  const double stiffness = stiffness_of(f, step);
  Eigen::Matrix<double, 12, 12> tangent = Eigen::Matrix<double, 12, 12>::Zero();
  for (int g = 0; g < 4; ++g) {
    const Tangents A = tangents(x, g);
    const auto& N = shape_gradients(g);
    const auto [at, stress] = tangent_point({f, g}, A, step, stiffness);
    Mat3 moduli;
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 3> of_metric = {k == 0 ? 2.0 : 0, k == 1 ? 2.0 : 0, k == 2 ? 1.0 : 0};
      put(at.stress_change(symmetric(of_metric.data())), moduli.col(k).data());
    }
    Eigen::Matrix<double, 3, 12> strains;
    for (int i = 0; i < 4; ++i)
      strains.middleCols<3>(3 * i) << N(i, 0) * A.col(0).transpose(), N(i, 1) * A.col(1).transpose(),
          (N(i, 0) * A.col(1) + N(i, 1) * A.col(0)).transpose();
    tangent += strains.transpose() * moduli * strains;
    const Eigen::Matrix4d turned = N * stress * N.transpose();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) tangent.block<3, 3>(3 * i, 3 * j).diagonal().array() += turned(i, j);
  }
  return tangent;
}

void MatrixLayer::add_tangent(const Step& step, TangentSink& tangent) const {
  chunks_.for_elements(
      [&](std::size_t f) {
        const Eigen::Matrix<double, 12, 12> of_corners = tangent_of(f, step);
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j <= i; ++j)
            tangent.add_block(faces_[f].nodes[i], faces_[f].nodes[j], of_corners.block<3, 3>(3 * i, 3 * j));
      },
      tangent.accepts_concurrent_blocks());
}

NodeGroups MatrixLayer::node_groups(std::span<const double> /*internal*/) const {
  NodeGroups groups;
  for (const Facet& face : faces_) groups.add(face.nodes);
  return groups;
}

// A strain of one rounding error over the width of a face.
double MatrixLayer::rounding(const Step& step, double position_rounding) const {
  double sum = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) sum += std::pow(3 * stiffness_of(f, step), 2);
  return std::sqrt(sum) * position_rounding;
}

std::vector<double> MatrixLayer::first_internal(const Tissue& tissue) const {
  const double released = 1 / (rule_.prestretch * rule_.prestretch);
  std::vector<double> internal(first_number({faces_.size(), 0}) + followed_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (int g = 0; g < 4; ++g) {
      const Tangents A = tangents(corners(tissue.rest_positions, faces_[f]), g);
      const Mat2 rest = released * (A.transpose() * A);
      double* numbers = &internal[first_number({f, g})];
      put(rest, numbers);
      numbers[3] = std::sqrt(rest.determinant());
      if (flows()) put(rest, numbers + 4);
    }
  return internal;
}

std::vector<double> MatrixLayer::next_internal(const Step& step) const {
  std::vector<double> internal(step.internal.begin(), step.internal.end());
  followed_.move_on(followed(std::span(internal)));
  if (!flows()) return internal;
  chunks_.for_elements([&](std::size_t f) {
    const Corners x = corners(step.positions, faces_[f]);
    for (int g = 0; g < 4; ++g) {
      double* numbers = &internal[first_number({f, g})];
      std::copy_n(numbers, 3, numbers + 4);
      put(point({f, g}, tangents(x, g), step, 1).rest(), numbers);
    }
  });
  return internal;
}

std::vector<double> MatrixLayer::with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                              double time_s) const {
  std::vector<double> result(internal.begin(), internal.end());
  followed_.follow(signals, time_s, followed(std::span(result)));
  return result;
}

std::unique_ptr<Law> MatrixLayer::after_change(const Tissue& tissue, const TissueChange& change,
                                               std::span<const Vec3> /*positions*/) const {
  return std::make_unique<MatrixLayer>(tissue, pattern_.after_change(change), rule_);
}

std::vector<double> MatrixLayer::internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                       const TissueChange& change,
                                                       const ChangePositions& positions) const {
  const std::vector<Facet> faces = bonded_faces(tissue, rule_.side, pattern_.after_change(change));
  const std::vector<std::size_t> first = first_facets(faces_, pattern_.cells.size());
  const auto former = former_facets(change, pattern_.cells.size(), faces_, faces);
  std::vector<double> after(first_number({faces.size(), 0}));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (former[f]) {
      std::copy_n(&internal[first_number({*former[f], 0})], first_number({1, 0}), &after[first_number({f, 0})]);
      continue;
    }
    const std::size_t origin = change.origin[faces[f].cell.index()].index();
    const Corners x = corners(positions.after, faces[f]);
    for (int g = 0; g < 4; ++g) {
      const Place from = nearest(first[origin], first[origin + 1], place_of(x, g), positions.before);
      const Tangents was = tangents(corners(positions.before, faces_[from.face]), from.point);
      const Mat2 map = map_between(was, tangents(x, g));
      carry(&internal[first_number(from)], map, &after[first_number({f, g})]);
    }
  }
  const std::vector<double> followed_after = followed_.after_change(followed(internal), change);
  after.insert(after.end(), followed_after.begin(), followed_after.end());
  return after;
}

MatrixLayer::Place MatrixLayer::nearest(std::size_t first, std::size_t last, const Vec3& place,
                                        std::span<const Vec3> positions) const {
  Place found;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = first; f < last; ++f) {
    const Corners x = corners(positions, faces_[f]);
    for (int g = 0; g < 4; ++g)
      if (const double distance = (place_of(x, g) - place).squaredNorm(); distance < least)
        least = distance, found = {f, g};
  }
  return found;
}

// Metrics and areas in the coordinates of another face.
void MatrixLayer::carry(const double* from, const Mat2& map, double* to) const {
  put(map.transpose() * symmetric(from) * map, to);
  to[3] = from[3] * std::abs(map.determinant());
  if (flows()) put(map.transpose() * symmetric(from + 4) * map, to + 4);
}

}  // namespace plica

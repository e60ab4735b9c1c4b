// SPDX-License-Identifier: Apache-2.0

// Python module `volcontact_timing` of peers_benchmark.py and mesh_benchmark.py: our queries timed
// without Python, the independent integral they are judged by, and the bumpy balls of the tests.
// The solids are those of the package `volcontact`.
#include <nanobind/eigen/dense.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>

#include <ctime>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "core/reference/reference_integral.h"
#include "core/support/meshes.h"
#include "volcontact/base/simd.h"
#include "volcontact/pair/interference.h"

namespace volcontact {
namespace {

namespace nb = nanobind;

using Poses = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

std::vector<Pose> poses_from(const Poses& matrices) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < matrices.shape(0); ++i) {
    const Eigen::Map<const Matrix4> X(matrices.data() + 16 * i);
    poses.push_back({X.topLeftCorner<3, 3>(), X.topRightCorner<3, 1>()});
  }
  return poses;
}

// Processor time of this thread [ns].
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

// Nanoseconds a query, over at least so many queries, all poses equally often.
double time_queries(const Shape& a, const Shape& b, const Poses& matrices, double tolerance,
                    const std::string& engine, int queries) {
  const std::vector<Pose> poses = poses_from(matrices);
  const InterferenceOptions options{tolerance, engine_from(engine), 1};
  InterferenceWorkspace workspace;
  Interference out;
  for (const Pose& X_AB : poses) interference(a, b, X_AB, options, workspace, out);  // warm
  const std::size_t rounds = 1 + static_cast<std::size_t>(queries) / poses.size();
  double keep = 0.0;
  const double begin = thread_time();
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const Pose& X_AB : poses) {
      interference(a, b, X_AB, options, workspace, out);
      keep += out.total.volume;
    }
  }
  const double time = thread_time() - begin;
  if (!(keep >= 0.0)) throw std::runtime_error("time_queries: a volume is no number");
  return time / static_cast<double>(rounds * poses.size());
}

// Volume of the overlap [m^3] and its error [m^3], by an integral that shares nothing with the
// engines. They only say where to look: the values do not depend on it.
std::tuple<double, double> reference_volume(const Shape& a, const Shape& b, const Matrix4& X,
                                            double half_range) {
  const Pose X_AB{X.topLeftCorner<3, 3>(), X.topRightCorner<3, 1>()};
  InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {}, workspace, out);
  const VolumeMetrics& m = out.total;
  const test::Reference r =
      test::reference_integral(test::reference_solid(a), test::reference_solid(b), X_AB,
                               {{basis_with_z(m.normal()), m.centroid}, half_range});
  return {r.metrics.volume, r.volume_error};
}

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Faces = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Points and triangles of a ball of about radius 1 with bumps, 20 * 4^levels triangles.
std::tuple<Points, Faces> bumpy_ball(int levels, int seed) {
  const test::Soup soup = test::bumpy_soup(levels, seed);
  Points points(soup.vertices.size(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = soup.vertices[i];
  Faces faces(soup.triangles.size(), 3);
  for (Eigen::Index i = 0; i < faces.rows(); ++i) {
    for (int corner = 0; corner < 3; ++corner) faces(i, corner) = soup.triangles[i][corner];
  }
  return {points, faces};
}

const char* simd_path() {
  constexpr const char* kNames[] = {"portable", "AVX2", "AVX-512"};
  return kNames[static_cast<int>(best_simd_path())];
}

}  // namespace

NB_MODULE(volcontact_timing, m) {
  nb::module_::import_("volcontact");
  m.def("time_queries", &time_queries, nb::arg("a"), nb::arg("b"), nb::arg("poses"), nb::kw_only(),
        nb::arg("tolerance"), nb::arg("engine"), nb::arg("queries"));
  m.def("reference_volume", &reference_volume, nb::arg("a"), nb::arg("b"), nb::arg("X_AB"),
        nb::arg("half_range"));
  m.def("bumpy_ball", &bumpy_ball, nb::arg("levels"), nb::arg("seed"));
  m.def("simd_path", &simd_path);
}

}  // namespace volcontact

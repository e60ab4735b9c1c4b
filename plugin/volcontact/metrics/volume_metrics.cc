// SPDX-License-Identifier: Apache-2.0
#include "volcontact/metrics/volume_metrics.h"

#include <algorithm>

namespace volcontact {
namespace {

// (tr M) 1 - M: inertia tensor from second moments.
Mat3 inertia_from_second(const Mat3& second) { return second.trace() * Mat3::Identity() - second; }

}  // namespace

const char* to_string(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kContained:
      return "contained";
    case Status::kApproximate:
      return "approximate";
    case Status::kUnbounded:
      return "unbounded";
    case Status::kInvalid:
      return "invalid";
  }
  return "unknown";
}

Mat3 VolumeMetrics::second_moment() const {
  return 0.5 * inertia.trace() * Mat3::Identity() - inertia;
}

double VolumeMetrics::flatness() const {
  const double smaller = std::min(area, counter_area);
  return smaller > 0.0 ? std::min(1.0, area_vector.norm() / smaller) : 0.0;
}

void transform(const Pose& X_WF, VolumeMetrics& metrics) {
  const Mat3& r = X_WF.rotation;
  metrics.centroid = X_WF * metrics.centroid;
  metrics.inertia = r * metrics.inertia * r.transpose();
  metrics.area_vector = r * metrics.area_vector;
  metrics.area_moment = r * metrics.area_moment + X_WF.translation.cross(metrics.area_vector);
}

VolumeMetrics transformed(const VolumeMetrics& metrics_F, const Pose& X_WF) {
  VolumeMetrics out = metrics_F;
  transform(X_WF, out);
  return out;
}

void reverse(VolumeMetrics& metrics) {
  metrics.area_vector = -metrics.area_vector;
  metrics.area_moment = -metrics.area_moment;
  std::swap(metrics.area, metrics.counter_area);
}

VolumeMetrics reversed(const VolumeMetrics& metrics) {
  VolumeMetrics out = metrics;
  reverse(out);
  return out;
}

VolumeMetrics operator+(const VolumeMetrics& a, const VolumeMetrics& b) {
  VolumeMetrics m;
  m.volume = a.volume + b.volume;
  if (m.volume > 0.0) {
    m.centroid = (a.volume * a.centroid + b.volume * b.centroid) / m.volume;
    const Vec3 apart = b.centroid - a.centroid;
    m.inertia = a.inertia + b.inertia +
                (a.volume * b.volume / m.volume) * inertia_from_second(outer(apart, apart));
  }
  m.area_vector = a.area_vector + b.area_vector;
  m.area_moment = a.area_moment + b.area_moment;
  m.area = a.area + b.area;
  m.counter_area = a.counter_area + b.counter_area;
  m.depth_moment = a.depth_moment + b.depth_moment;
  m.depth = std::max(a.depth, b.depth);
  m.volume_error = a.volume_error + b.volume_error;
  m.status = std::max(a.status, b.status);
  return m;
}

MomentSum& MomentSum::operator+=(const MomentSum& other) {
  volume += other.volume;
  first += other.first;
  second += other.second;
  area_vector += other.area_vector;
  area_moment += other.area_moment;
  area += other.area;
  counter_area += other.counter_area;
  return *this;
}

VolumeMetrics MomentSum::metrics() const {
  VolumeMetrics m;
  if (!(volume > 0.0)) return m;
  m.volume = volume;
  m.centroid = first / volume;
  m.inertia = inertia_from_second(second - outer(m.centroid, first));
  m.area_vector = area_vector;
  m.area_moment = area_moment;
  m.area = area;
  m.counter_area = counter_area;
  return m;
}

bool is_finite(const VolumeMetrics& m) {
  const double sum = m.volume + m.volume_error + m.area + m.counter_area + m.depth +
                     m.depth_moment + m.centroid.sum() + m.inertia.sum() + m.area_vector.sum() +
                     m.area_moment.sum();
  if (std::isfinite(sum)) return true;
  return std::isfinite(m.volume) && m.centroid.allFinite() && m.inertia.allFinite() &&
         m.area_vector.allFinite() && m.area_moment.allFinite() && std::isfinite(m.area) &&
         std::isfinite(m.counter_area) && std::isfinite(m.depth_moment) && std::isfinite(m.depth) &&
         std::isfinite(m.volume_error);
}

}  // namespace volcontact

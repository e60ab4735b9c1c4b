// SPDX-License-Identifier: Apache-2.0
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <sstream>

#include "bindings.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact::python {

namespace nb = nanobind;

void bind_metrics(nb::module_& m) {
  nb::class_<VolumeMetrics>(m, "VolumeMetrics",
                            "Metrics of an interference volume, in one frame and about its origin "
                            "(docs/theory.md, 'Volume metrics').")
      .def_ro("volume", &VolumeMetrics::volume, "V [m^3]")
      .def_ro("centroid", &VolumeMetrics::centroid, nb::rv_policy::copy,
              "Centroid of the volume [m], shape (3,)")
      .def_ro("inertia", &VolumeMetrics::inertia, nb::rv_policy::copy,
              "Inertia tensor about the centroid, unit density [m^5], shape (3, 3)")
      .def_prop_ro(
          "second_moment", [](const VolumeMetrics& self) { return self.second_moment(); },
          "Integral of r r^T over the volume, r from the centroid [m^5], shape (3, 3)")
      .def_ro("area_vector", &VolumeMetrics::area_vector, nb::rv_policy::copy,
              "Integral of A's outward normal over A's surface inside B = dV/dx of A [m^2], "
              "shape (3,)")
      .def_ro("area_moment", &VolumeMetrics::area_moment, nb::rv_policy::copy,
              "Integral of x cross that normal, about the frame's origin = dV/dtheta of A [m^3], "
              "shape (3,)")
      .def_ro("area", &VolumeMetrics::area, "Area of A's surface inside B [m^2]")
      .def_ro("counter_area", &VolumeMetrics::counter_area, "Area of B's surface inside A [m^2]")
      .def_ro("depth_moment", &VolumeMetrics::depth_moment,
              "Integral of L^2/2 over the patch, L the column length along the normal [m^4]")
      .def_ro("depth", &VolumeMetrics::depth,
              "How deep one solid lies in the other, along the normal [m]")
      .def_ro("volume_error", &VolumeMetrics::volume_error,
              "Bound or estimate of the error of the volume [m^3]")
      .def_prop_ro(
          "normal", [](const VolumeMetrics& self) { return self.normal(); },
          "Contact normal on A, from B to A, shape (3,); zero where there is none")
      .def_prop_ro("flatness", &VolumeMetrics::flatness,
                   "|area_vector| over the smaller surface, 1 for a flat patch [-]")
      .def_prop_ro("touching", &VolumeMetrics::touching, "Whether the volume is positive")
      .def_prop_ro(
          "status", [](const VolumeMetrics& self) { return to_string(self.status); },
          "'ok', 'contained', 'approximate', 'unbounded' or 'invalid'")
      .def("__repr__", [](const VolumeMetrics& self) {
        std::ostringstream text;
        text << "<volume " << self.volume << " m^3, centroid (" << self.centroid
             << ") m, area vector (" << self.area_vector << ") m^2, " << to_string(self.status)
             << ">";
        return text.str();
      });
}

}  // namespace volcontact::python

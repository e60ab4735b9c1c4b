// SPDX-License-Identifier: Apache-2.0
#include <omp.h>

#include "bindings.h"
#include "volcontact/base/simd.h"

namespace {

const char* instruction_set() {
  switch (volcontact::best_simd_path()) {
    case volcontact::SimdPath::kAvx512:
      return "avx512";
    case volcontact::SimdPath::kAvx2:
      return "avx2";
    case volcontact::SimdPath::kPortable:
      return "portable";
  }
  return "portable";
}

}  // namespace

NB_MODULE(_volcontact, m) {
  m.doc() = "Compiled core of volcontact: solids, interference volumes, laws, contact models.";
  volcontact::python::bind_metrics(m);
  volcontact::python::bind_shapes(m);
  volcontact::python::bind_signed_distance(m);
  volcontact::python::bind_interference(m);
  volcontact::python::bind_laws(m);
  volcontact::python::bind_own_laws(m);
  volcontact::python::bind_model(m);
  m.def("instruction_set", &instruction_set,
        "The instructions the kernels use on this machine: 'portable', 'avx2' or 'avx512'; the "
        "results are the same to the last bit");
  m.def("most_threads", &omp_get_max_threads,
        "How many threads an evaluation may use: the processors, or OMP_NUM_THREADS");
  m.def("version", [] { return VOLCONTACT_VERSION; }, "Of the package, as in its pyproject.toml");
  volcontact::python::speak_plainly(m);
}

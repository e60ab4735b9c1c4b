// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

NB_MODULE(_volcontact, m) {
  m.doc() = "Compiled core of volcontact: solids, interference volumes, laws, contact models.";
  volcontact::python::bind_metrics(m);
  volcontact::python::bind_shapes(m);
  volcontact::python::bind_signed_distance(m);
  volcontact::python::bind_interference(m);
  volcontact::python::bind_laws(m);
  volcontact::python::bind_own_laws(m);
  volcontact::python::bind_model(m);
}

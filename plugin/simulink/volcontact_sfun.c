/* SPDX-License-Identifier: Apache-2.0 */
/* The contact model container as a Simulink S-function of level 2, for those who import no FMU.
 * docs/simulink.md tells how to compile and wire it.
 *
 * Parameters  1 model as text (vc_model_text)       char
 *             2 sites that keep memory, >= 1        scalar
 *             3 sample time [s], 0: continuous      scalar
 *             4 names of tunable parameters         char, parted by spaces, may be ''
 *             5 their numbers                       vector, tunable
 * Inputs      X_WA [4x4], V_WA [6], X_WB [4x4], V_WB [6]; twists: angular, then linear, in W
 * Outputs     force on A [3], torque on A [3], force on B [3], torque on B [3], contact [9]:
 *             volume, depth, area, sites, elastic energy, dissipated power (normal, roll, slide,
 *             spin)
 * States      discrete, where the laws keep something: the time of the last accepted step, then
 *             the array of vc_model_state_size. */
#define S_FUNCTION_NAME volcontact_sfun
#define S_FUNCTION_LEVEL 2

#include <math.h>
#include <string.h>

#include "c_api/volcontact.h"
#include "simstruc.h"

enum { kModelText, kSites, kSampleTime, kTunableNames, kTunableNumbers, kParameters };
enum { kPoseA, kTwistA, kPoseB, kTwistB, kInputs };
enum { kForceA, kTorqueA, kForceB, kTorqueB, kContact, kOutputs };
enum { kContactNumbers = 9, kMostSites = 1000 };
enum { kModel, kWorkspace, kPointers }; /* of PWork */
enum { kTouching, kIntegers };          /* of IWork */

/* ---- Parameters ------------------------------------------------------------------------------ */

static int is_real_vector(const mxArray* value) {
  return mxIsDouble(value) && !mxIsComplex(value) && !mxIsSparse(value);
}

static int is_scalar(const mxArray* value) {
  return is_real_vector(value) && mxGetNumberOfElements(value) == 1;
}

/* Sets the numbers of parameter 5 by the names of parameter 4. False, with the error set, where
 * they are wrong. */
static int set_tunables(SimStruct* S, vc_model* model) {
  const double* numbers = mxGetPr(ssGetSFcnParam(S, kTunableNumbers));
  const size_t count = mxGetNumberOfElements(ssGetSFcnParam(S, kTunableNumbers));
  char* names = mxArrayToString(ssGetSFcnParam(S, kTunableNames));
  size_t used = 0;
  int good = 1;
  char* name = names ? strtok(names, " ,;") : NULL;
  for (; name && good; name = strtok(NULL, " ,;"), ++used) {
    if (used < count && vc_model_set(model, name, &numbers[used], 1) < 0) {
      ssSetErrorStatus(S, vc_error());
      good = 0;
    }
  }
  mxFree(names);
  if (good && used != count) {
    ssSetErrorStatus(S,
                     "volcontact_sfun: parameter 5 must have one number for each name of "
                     "parameter 4");
    good = 0;
  }
  return good;
}

/* The model of the parameters; null, with the error set, where they are wrong. */
static vc_model* model_of(SimStruct* S) {
  vc_model* model = NULL;
  char* text = mxArrayToString(ssGetSFcnParam(S, kModelText));
  const int code = vc_model_create_text(text ? text : "", &model);
  mxFree(text);
  if (code < 0) {
    ssSetErrorStatus(S, vc_error());
    return NULL;
  }
  if (!set_tunables(S, model)) {
    vc_model_free(model);
    return NULL;
  }
  return model;
}

static int sites_of(SimStruct* S) { return (int)mxGetScalar(ssGetSFcnParam(S, kSites)); }

/* Discrete states: none where the laws keep nothing. */
static int state_count(SimStruct* S, const vc_model* model) {
  const int size = vc_model_state_size(model, sites_of(S));
  return size > 0 ? size + 1 : 0;
}

static const char* wrong_parameter(SimStruct* S) {
  const mxArray* sites = ssGetSFcnParam(S, kSites);
  const mxArray* sample_time = ssGetSFcnParam(S, kSampleTime);
  if (!mxIsChar(ssGetSFcnParam(S, kModelText)) || mxIsEmpty(ssGetSFcnParam(S, kModelText))) {
    return "volcontact_sfun: parameter 1 must be the text of a model, as fileread('ball.txt')";
  }
  if (!is_scalar(sites) || !(mxGetScalar(sites) >= 1.0 && mxGetScalar(sites) <= kMostSites) ||
      mxGetScalar(sites) != floor(mxGetScalar(sites))) {
    return "volcontact_sfun: parameter 2, sites that keep memory, must be a whole number from 1 "
           "to 1000";
  }
  if (!is_scalar(sample_time) ||
      !(mxGetScalar(sample_time) >= 0.0 && mxGetScalar(sample_time) < mxGetInf())) {
    return "volcontact_sfun: parameter 3, the sample time [s], must be > 0, or 0 for continuous";
  }
  if (!mxIsChar(ssGetSFcnParam(S, kTunableNames)) && !mxIsEmpty(ssGetSFcnParam(S, kTunableNames))) {
    return "volcontact_sfun: parameter 4 must be names parted by spaces, as 'stiffness friction', "
           "or ''";
  }
  if (!is_real_vector(ssGetSFcnParam(S, kTunableNumbers))) {
    return "volcontact_sfun: parameter 5 must be a vector of real numbers, or []";
  }
  return NULL;
}

#define MDL_CHECK_PARAMETERS
/* Before the start, and whenever a parameter is changed in a run. */
static void mdlCheckParameters(SimStruct* S) {
  const char* wrong = wrong_parameter(S);
  vc_model* model;
  if (wrong) {
    ssSetErrorStatus(S, wrong);
    return;
  }
  model = model_of(S);
  if (!model) return;
  if (ssGetPWork(S) && ssGetPWorkValue(S, kModel) &&
      state_count(S, model) != ssGetNumDiscStates(S)) {
    ssSetErrorStatus(S,
                     "volcontact_sfun: the new numbers change what the laws keep; stop the "
                     "simulation to change them");
  }
  vc_model_free(model);
}

#define MDL_PROCESS_PARAMETERS
/* Takes over tunable numbers that mdlCheckParameters has found right. */
static void mdlProcessParameters(SimStruct* S) {
  vc_model* model = ssGetPWork(S) ? (vc_model*)ssGetPWorkValue(S, kModel) : NULL;
  if (model) set_tunables(S, model);
}

/* ---- Sizes ----------------------------------------------------------------------------------- */

static int set_ports(SimStruct* S) {
  int i;
  if (!ssSetNumInputPorts(S, kInputs) || !ssSetNumOutputPorts(S, kOutputs)) return 0;
  for (i = 0; i < kInputs; ++i) {
    if (i == kPoseA || i == kPoseB) {
      if (!ssSetInputPortMatrixDimensions(S, i, 4, 4)) return 0;
    } else {
      ssSetInputPortWidth(S, i, 6);
    }
    ssSetInputPortRequiredContiguous(S, i, 1);
    ssSetInputPortDirectFeedThrough(S, i, 1);
  }
  for (i = 0; i < kContact; ++i) ssSetOutputPortWidth(S, i, 3);
  ssSetOutputPortWidth(S, kContact, kContactNumbers);
  return 1;
}

static void mdlInitializeSizes(SimStruct* S) {
  vc_model* model;
  int i;
  ssSetNumSFcnParams(S, kParameters);
  if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) return; /* Simulink tells of it */
  if (VC_CHECK() < 0) {
    ssSetErrorStatus(S, vc_error());
    return;
  }
  mdlCheckParameters(S);
  if (ssGetErrorStatus(S)) return;
  for (i = 0; i < kParameters; ++i) ssSetSFcnParamTunable(S, i, SS_PRM_NOT_TUNABLE);
  ssSetSFcnParamTunable(S, kTunableNumbers, SS_PRM_SIM_ONLY_TUNABLE);
  if (!set_ports(S)) return;
  model = model_of(S);
  if (!model) return;
  ssSetNumContStates(S, 0);
  ssSetNumDiscStates(S, state_count(S, model));
  vc_model_free(model);
  ssSetNumSampleTimes(S, 1);
  ssSetNumPWork(S, kPointers);
  ssSetNumIWork(S, kIntegers);
  ssSetNumNonsampledZCs(S, 1);
  ssSetOptions(S, 0);
}

static void mdlInitializeSampleTimes(SimStruct* S) {
  const double step = mxGetScalar(ssGetSFcnParam(S, kSampleTime));
  ssSetSampleTime(S, 0, step > 0.0 ? step : CONTINUOUS_SAMPLE_TIME);
  ssSetOffsetTime(S, 0, 0.0);
}

/* ---- A run ----------------------------------------------------------------------------------- */

#define MDL_START
static void mdlStart(SimStruct* S) {
  vc_workspace* workspace = NULL;
  ssSetPWorkValue(S, kModel, model_of(S));
  if (vc_workspace_create(&workspace) < 0) ssSetErrorStatus(S, vc_error());
  ssSetPWorkValue(S, kWorkspace, workspace);
}

#define MDL_INITIALIZE_CONDITIONS
/* Zeros: the bodies were apart. */
static void mdlInitializeConditions(SimStruct* S) {
  real_T* states = ssGetRealDiscStates(S);
  const int count = ssGetNumDiscStates(S);
  int i;
  for (i = 0; i < count; ++i) states[i] = 0.0;
  if (count > 0) states[0] = ssGetT(S);
}

/* Simulink's matrices lie column by column. */
static void copy_pose(const real_T* from, double* to) {
  int row, column;
  for (row = 0; row < 4; ++row) {
    for (column = 0; column < 4; ++column) to[4 * row + column] = from[4 * column + row];
  }
}

/* From the states of the last accepted step; `next` gets those of now, where it is not null. */
static int evaluate(SimStruct* S, double* next, vc_result* result) {
  const int size = ssGetNumDiscStates(S) - 1;
  real_T* states = size > 0 ? ssGetRealDiscStates(S) : NULL;
  const double elapsed = states ? ssGetT(S) - states[0] : 0.0;
  vc_motion motion;
  copy_pose(ssGetInputPortRealSignal(S, kPoseA), motion.X_WA);
  copy_pose(ssGetInputPortRealSignal(S, kPoseB), motion.X_WB);
  memcpy(motion.V_WA, ssGetInputPortRealSignal(S, kTwistA), sizeof motion.V_WA);
  memcpy(motion.V_WB, ssGetInputPortRealSignal(S, kTwistB), sizeof motion.V_WB);
  if (vc_evaluate((const vc_model*)ssGetPWorkValue(S, kModel),
                  (vc_workspace*)ssGetPWorkValue(S, kWorkspace), &motion,
                  states ? states + 1 : NULL, next, states ? size : 0,
                  elapsed > 0.0 ? elapsed : 0.0, result) < 0) {
    ssSetErrorStatus(S, vc_error());
    return 0;
  }
  return 1;
}

/* Called any number of times in a step, also by minor steps: it changes no state. */
static void mdlOutputs(SimStruct* S, int_T tid) {
  vc_result result;
  real_T* contact = ssGetOutputPortRealSignal(S, kContact);
  (void)tid;
  if (!evaluate(S, NULL, &result)) return;
  memcpy(ssGetOutputPortRealSignal(S, kForceA), result.force_on_a, sizeof result.force_on_a);
  memcpy(ssGetOutputPortRealSignal(S, kTorqueA), result.torque_on_a, sizeof result.torque_on_a);
  memcpy(ssGetOutputPortRealSignal(S, kForceB), result.force_on_b, sizeof result.force_on_b);
  memcpy(ssGetOutputPortRealSignal(S, kTorqueB), result.torque_on_b, sizeof result.torque_on_b);
  contact[0] = result.metrics.volume;
  contact[1] = result.metrics.depth;
  contact[2] = result.metrics.area;
  contact[3] = result.sites;
  contact[4] = result.elastic_energy;
  memcpy(&contact[5], result.power, sizeof result.power);
  ssSetIWorkValue(S, kTouching, result.sites > 0);
}

#define MDL_UPDATE
/* A step is accepted: what the laws keep moves on. */
static void mdlUpdate(SimStruct* S, int_T tid) {
  vc_result result;
  (void)tid;
  if (ssGetNumDiscStates(S) == 0) return;
  if (!evaluate(S, ssGetRealDiscStates(S) + 1, &result)) return;
  ssGetRealDiscStates(S)[0] = ssGetT(S);
  if (result.forgotten > 0) {
    ssSetErrorStatus(S,
                     "volcontact_sfun: the bodies touch at more sites than parameter 2 has memory "
                     "for; raise it");
  }
}

#define MDL_ZERO_CROSSINGS
/* Crosses zero at touch and at release, which solvers of variable step find by bisection. */
static void mdlZeroCrossings(SimStruct* S) {
  ssGetNonsampledZCs(S)[0] = ssGetIWorkValue(S, kTouching) ? 1.0 : -1.0;
}

/* Also called after an error, when not all may be there. */
static void mdlTerminate(SimStruct* S) {
  if (!ssGetPWork(S)) return;
  vc_workspace_free((vc_workspace*)ssGetPWorkValue(S, kWorkspace));
  vc_model_free((vc_model*)ssGetPWorkValue(S, kModel));
  ssSetPWorkValue(S, kWorkspace, NULL);
  ssSetPWorkValue(S, kModel, NULL);
}

#ifdef MATLAB_MEX_FILE
#include "simulink.c"
#else
#include "cg_sfun.h"
#endif

/* SPDX-License-Identifier: Apache-2.0 */
#ifndef SIMULINK_MOCK_SIMSTRUC_H_
#define SIMULINK_MOCK_SIMSTRUC_H_

/* A stand-in of our own for the documented names that plugin/simulink/volcontact_sfun.c uses, so
 * that it can be compiled and run where no Simulink is. Nothing here is taken from its headers: the
 * names and what they mean are those of its public documentation. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double real_T;
typedef int int_T;

/* ---- Arrays of MATLAB ------------------------------------------------------------------------ */

typedef struct mxArray {
  const char* text; /* a char array, or null */
  const double* numbers;
  size_t count;
} mxArray;

#define mxIsChar(a) ((a)->text != NULL)
#define mxIsDouble(a) ((a)->text == NULL)
#define mxIsComplex(a) ((void)(a), 0)
#define mxIsSparse(a) ((void)(a), 0)
#define mxGetNumberOfElements(a) ((a)->text ? strlen((a)->text) : (a)->count)
#define mxIsEmpty(a) (mxGetNumberOfElements(a) == 0)
#define mxGetPr(a) ((a)->numbers)
#define mxGetScalar(a) ((a)->numbers[0])
#define mxGetInf() ((double)INFINITY)
#define mxFree(p) free(p)

static inline char* mxArrayToString(const mxArray* array) {
  char* copy;
  if (!array->text) return NULL;
  copy = (char*)malloc(strlen(array->text) + 1);
  return copy ? strcpy(copy, array->text) : NULL;
}

/* ---- A block --------------------------------------------------------------------------------- */

enum { MOCK_PORTS = 8, MOCK_PARAMETERS = 8, MOCK_WIDTH = 16, MOCK_WORK = 4 };
#define SS_PRM_NOT_TUNABLE 0
#define SS_PRM_SIM_ONLY_TUNABLE 2
#define CONTINUOUS_SAMPLE_TIME 0.0

typedef struct SimStruct {
  const char* error;
  int parameters_expected, parameters_given, tunable[MOCK_PARAMETERS];
  mxArray parameters[MOCK_PARAMETERS];
  int inputs, outputs, input_width[MOCK_PORTS], output_width[MOCK_PORTS];
  int contiguous[MOCK_PORTS], feedthrough[MOCK_PORTS];
  double input[MOCK_PORTS][MOCK_WIDTH], output[MOCK_PORTS][MOCK_WIDTH];
  int continuous_states, discrete_states, pointers, integers, zero_crossings, sample_times;
  double* states; /* made of the counts by whoever runs the block, as is `pointer` */
  void** pointer;
  int integer[MOCK_WORK];
  double zero_crossing[MOCK_WORK], sample_time, offset_time, time;
} SimStruct;

static inline int mock_matrix(SimStruct* S, int port, int rows, int columns) {
  S->input_width[port] = rows * columns;
  return 1;
}

#define ssSetErrorStatus(S, message) ((S)->error = (message))
#define ssGetErrorStatus(S) ((S)->error)
#define ssSetNumSFcnParams(S, n) ((S)->parameters_expected = (n))
#define ssGetNumSFcnParams(S) ((S)->parameters_expected)
#define ssGetSFcnParamsCount(S) ((S)->parameters_given)
#define ssGetSFcnParam(S, i) ((const mxArray*)&(S)->parameters[i])
#define ssSetSFcnParamTunable(S, i, how) ((S)->tunable[i] = (how))
#define ssSetNumInputPorts(S, n) ((S)->inputs = (n), 1)
#define ssSetNumOutputPorts(S, n) ((S)->outputs = (n), 1)
#define ssSetInputPortWidth(S, port, n) ((S)->input_width[port] = (n))
#define ssSetInputPortMatrixDimensions(S, port, m, n) mock_matrix(S, port, m, n)
#define ssSetInputPortRequiredContiguous(S, port, yes) ((S)->contiguous[port] = (yes))
#define ssSetInputPortDirectFeedThrough(S, port, yes) ((S)->feedthrough[port] = (yes))
#define ssSetOutputPortWidth(S, port, n) ((S)->output_width[port] = (n))
#define ssGetInputPortRealSignal(S, port) ((const real_T*)(S)->input[port])
#define ssGetOutputPortRealSignal(S, port) ((S)->output[port])
#define ssSetNumContStates(S, n) ((S)->continuous_states = (n))
#define ssSetNumDiscStates(S, n) ((S)->discrete_states = (n))
#define ssGetNumDiscStates(S) ((S)->discrete_states)
#define ssGetRealDiscStates(S) ((S)->states)
#define ssSetNumPWork(S, n) ((S)->pointers = (n))
#define ssGetPWork(S) ((S)->pointer)
#define ssGetPWorkValue(S, i) ((S)->pointer[i])
#define ssSetPWorkValue(S, i, value) ((S)->pointer[i] = (value))
#define ssSetNumIWork(S, n) ((S)->integers = (n))
#define ssGetIWorkValue(S, i) ((S)->integer[i])
#define ssSetIWorkValue(S, i, value) ((S)->integer[i] = (value))
#define ssSetNumNonsampledZCs(S, n) ((S)->zero_crossings = (n))
#define ssGetNonsampledZCs(S) ((S)->zero_crossing)
#define ssSetNumSampleTimes(S, n) ((S)->sample_times = (n))
#define ssSetSampleTime(S, i, t) ((void)(i), (S)->sample_time = (t))
#define ssSetOffsetTime(S, i, t) ((void)(i), (S)->offset_time = (t))
#define ssSetOptions(S, options) ((void)(S), (void)(options))
#define ssGetT(S) ((S)->time)

#endif /* SIMULINK_MOCK_SIMSTRUC_H_ */

/* SPDX-License-Identifier: Apache-2.0 */
/* Included at the end of an S-function: a table of its methods for whoever runs it. */
#include "simulink_methods.h"

const simulink_methods volcontact_sfun_methods = {
    mdlInitializeSizes, mdlInitializeSampleTimes,
    mdlStart,           mdlInitializeConditions,
    mdlOutputs,         mdlUpdate,
    mdlZeroCrossings,   mdlTerminate,
    mdlCheckParameters, mdlProcessParameters,
};

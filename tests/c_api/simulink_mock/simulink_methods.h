/* SPDX-License-Identifier: Apache-2.0 */
#ifndef SIMULINK_MOCK_SIMULINK_METHODS_H_
#define SIMULINK_MOCK_SIMULINK_METHODS_H_

#include "simstruc.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct simulink_methods {
  void (*initialize_sizes)(SimStruct* S);
  void (*initialize_sample_times)(SimStruct* S);
  void (*start)(SimStruct* S);
  void (*initialize_conditions)(SimStruct* S);
  void (*outputs)(SimStruct* S, int_T tid);
  void (*update)(SimStruct* S, int_T tid);
  void (*zero_crossings)(SimStruct* S);
  void (*terminate)(SimStruct* S);
  void (*check_parameters)(SimStruct* S);
  void (*process_parameters)(SimStruct* S);
} simulink_methods;

extern const simulink_methods volcontact_sfun_methods;

#ifdef __cplusplus
}
#endif

#endif /* SIMULINK_MOCK_SIMULINK_METHODS_H_ */

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fmu/fmi2.h"
#include "fmu/fmi3.h"

// The functions of both standards that the tests call, as the libraries export them.
using volcontact::fmi2::Callbacks;
using volcontact::fmi2::EventInfo;
extern "C" {
void* fmi2Instantiate(const char*, int, const char*, const char*, const Callbacks*, int, int);
void fmi2FreeInstance(void*);
int fmi2SetupExperiment(void*, int, double, double, int, double);
int fmi2EnterInitializationMode(void*);
int fmi2ExitInitializationMode(void*);
int fmi2Terminate(void*);
int fmi2Reset(void*);
int fmi2GetReal(void*, const unsigned*, std::size_t, double*);
int fmi2GetInteger(void*, const unsigned*, std::size_t, int*);
int fmi2GetBoolean(void*, const unsigned*, std::size_t, int*);
int fmi2SetReal(void*, const unsigned*, std::size_t, const double*);
int fmi2SetInteger(void*, const unsigned*, std::size_t, const int*);
int fmi2GetFMUstate(void*, void**);
int fmi2SetFMUstate(void*, void*);
int fmi2FreeFMUstate(void*, void**);
int fmi2SerializedFMUstateSize(void*, void*, std::size_t*);
int fmi2SerializeFMUstate(void*, void*, char*, std::size_t);
int fmi2DeSerializeFMUstate(void*, const char*, std::size_t, void**);
int fmi2GetDirectionalDerivative(void*, const unsigned*, std::size_t, const unsigned*, std::size_t,
                                 const double*, double*);
int fmi2EnterEventMode(void*);
int fmi2NewDiscreteStates(void*, EventInfo*);
int fmi2EnterContinuousTimeMode(void*);
int fmi2CompletedIntegratorStep(void*, int, int*, int*);
int fmi2SetTime(void*, double);
int fmi2SetContinuousStates(void*, const double*, std::size_t);
int fmi2GetDerivatives(void*, double*, std::size_t);
int fmi2GetEventIndicators(void*, double*, std::size_t);
int fmi2GetContinuousStates(void*, double*, std::size_t);
int fmi2GetNominalsOfContinuousStates(void*, double*, std::size_t);
int fmi2DoStep(void*, double, double, int);
int fmi2GetRealStatus(void*, int, double*);

void* fmi3InstantiateModelExchange(const char*, const char*, const char*, bool, bool, void*,
                                   volcontact::fmi3::Log);
void* fmi3InstantiateCoSimulation(const char*, const char*, const char*, bool, bool, bool, bool,
                                  const std::uint32_t*, std::size_t, void*, volcontact::fmi3::Log,
                                  volcontact::fmi3::IntermediateUpdate);
void fmi3FreeInstance(void*);
int fmi3EnterInitializationMode(void*, bool, double, double, bool, double);
int fmi3ExitInitializationMode(void*);
int fmi3EnterEventMode(void*);
int fmi3Terminate(void*);
int fmi3Reset(void*);
int fmi3GetFloat64(void*, const std::uint32_t*, std::size_t, double*, std::size_t);
int fmi3SetFloat64(void*, const std::uint32_t*, std::size_t, const double*, std::size_t);
int fmi3GetInt32(void*, const std::uint32_t*, std::size_t, std::int32_t*, std::size_t);
int fmi3GetFMUState(void*, void**);
int fmi3SetFMUState(void*, void*);
int fmi3FreeFMUState(void*, void**);
int fmi3UpdateDiscreteStates(void*, bool*, bool*, bool*, bool*, bool*, double*);
int fmi3EnterContinuousTimeMode(void*);
int fmi3CompletedIntegratorStep(void*, bool, bool*, bool*);
int fmi3SetTime(void*, double);
int fmi3SetContinuousStates(void*, const double*, std::size_t);
int fmi3GetContinuousStateDerivatives(void*, double*, std::size_t);
int fmi3GetContinuousStates(void*, double*, std::size_t);
int fmi3EnterStepMode(void*);
int fmi3DoStep(void*, double, double, bool, bool*, bool*, bool*, double*);
int fmi3GetDirectionalDerivative(void*, const std::uint32_t*, std::size_t, const std::uint32_t*,
                                 std::size_t, const double*, std::size_t, double*, std::size_t);
}

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace volcontact {

/// Half of a symmetric Gauss-Legendre rule on [-1, 1]: the positive nodes.
struct GaussNode {
  double x;
  double weight;
};

inline constexpr GaussNode kGauss6[] = {{0.238619186083196909, 0.467913934572691047},
                                        {0.661209386466264514, 0.360761573048138608},
                                        {0.932469514203152028, 0.171324492379170345}};
inline constexpr GaussNode kGauss8[] = {{0.183434642495649805, 0.362683783378361983},
                                        {0.525532409916328986, 0.313706645877887287},
                                        {0.796666477413626740, 0.222381034453374471},
                                        {0.960289856497536232, 0.101228536290376259}};
inline constexpr GaussNode kGauss12[] = {
    {0.125233408511468915, 0.249147045813402785}, {0.367831498998180194, 0.233492536538354809},
    {0.587317954286617447, 0.203167426723065922}, {0.769902674194304687, 0.160078328543346226},
    {0.904117256370474857, 0.106939325995318431}, {0.981560634246719251, 0.047175336386511827}};
inline constexpr GaussNode kGauss16[] = {
    {0.095012509837637440, 0.189450610455068496}, {0.281603550779258913, 0.182603415044923589},
    {0.458016777657227386, 0.169156519395002538}, {0.617876244402643748, 0.149595988816576732},
    {0.755404408355003034, 0.124628971255533872}, {0.865631202387831744, 0.095158511682492785},
    {0.944575023073232576, 0.062253523938647893}, {0.989400934991649933, 0.027152459411754095}};

/// The rule that integrates products of five sines and cosines over `range` [rad] to rounding.
inline std::span<const GaussNode> gauss_rule_for(double range) {
  if (range < 0.7) return kGauss8;
  if (range < 1.7) return kGauss12;
  return kGauss16;
}

}  // namespace volcontact

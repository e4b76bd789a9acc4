// Factors from the units of scenarios and results to those inside plica (um, s, nN; mass in g, stress in kPa).
#pragma once

namespace plica::units {

inline constexpr double pascal = 1e-3;                     // nN/um^2
inline constexpr double pascal_second = 1e-3;              // nN s/um^2
inline constexpr double pascal_second_per_um = 1e-3;       // nN s/um^3
inline constexpr double minute = 60.0;                     // s
inline constexpr double kilogram_per_cubic_metre = 1e-15;  // g/um^3
inline constexpr double um_per_minute = 1.0 / 60.0;        // um/s

}  // namespace plica::units

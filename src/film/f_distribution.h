// SPDX-License-Identifier: Apache-2.0
// Fisher's F distribution: the ratio of two independent mean squares.
#pragma once

namespace clrt {

/// Probability that a number of Fisher's F distribution with these degrees of freedom, above 0 and not
/// necessarily whole, is at most `value`.
double f_probability(double value, double degrees_above, double degrees_below);

/// The number that it stays below with `probability`, between 0 and 1; relative precision 1e-9 up to 1e6
/// degrees of freedom.
double f_quantile(double probability, double degrees_above, double degrees_below);

} // namespace clrt

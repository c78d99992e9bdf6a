// SPDX-License-Identifier: Apache-2.0
// One hard case of the catalogue: what is set up, what judges it, which figure passes, and what each build of
// the kernels gave.
#pragma once

#include "probes/probe_device.h"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

namespace clrt {

/// How many inputs the cases try: minutes, an hour or so, hours in all.
enum class Tier { QUICK, NIGHT, LONG };

/// What is compared: the textbook's formula in float, clrt's kernels, the same with relaxed maths, the same
/// in double.
enum class Build { NAIVE, SINGLE, FAST, DOUBLE };
constexpr Build ALL_BUILDS[] = {Build::NAIVE, Build::SINGLE, Build::FAST, Build::DOUBLE};
constexpr size_t BUILD_COUNT = 4;

/// "naive", "single", "fast", "double".
const char* build_name(Build build);

/// The worst of many inputs, or how many of them failed.
struct Worst {
    double value = 0; ///< largest deviation or number of failures; infinite once a deviation is NaN
    std::uint64_t tried = 0;
    std::string input; ///< the worst one; hex floats where the bits matter

    /// Takes in one deviation (>= 0, or NaN); `describe()` is asked for its input when it is the worst so
    /// far.
    template <class Describe>
    void see(double deviation, const Describe& describe) {
        ++tried;
        if (deviation <= value)
            return;
        value = deviation > value ? deviation : INFINITE;
        input = describe();
    }
    /// Counts one input that failed or did not; the first failure is described.
    template <class Describe>
    void count(bool failed, const Describe& describe) {
        ++tried;
        if (failed && value++ == 0)
            input = describe();
    }

private:
    static constexpr double INFINITE = std::numeric_limits<double>::infinity();
};

/// One figure of a case with its limit; what is not measured by a build stays without inputs.
struct Figure {
    std::string quantity; ///< with its unit: "|dF|", "rays lost"
    double limit = 0;     ///< for single and double; naive and fast are shown beside them
    std::array<Worst, BUILD_COUNT> builds;

    Worst& operator[](Build build) { return builds[static_cast<size_t>(build)]; }
    const Worst& operator[](Build build) const { return builds[static_cast<size_t>(build)]; }
    /// Whether single was measured and neither it nor double is beyond the limit.
    bool holds() const;
};

/// What a case is given and what it fills in.
class CaseRun {
public:
    CaseRun(const ProbeDevice& run_device, Tier run_tier) : device(run_device), tier(run_tier) {}

    const ProbeDevice& device;
    const Tier tier;

    /// The number of inputs for the tier.
    size_t count(double quick, double night, double at_length) const;
    /// The builds that the device has: no double without fp64.
    std::vector<Build> builds() const;
    /// Adds a figure; the reference stays valid.
    Figure& figure(std::string quantity, double limit);
    const std::deque<Figure>& figures() const { return figures_; }

private:
    std::deque<Figure> figures_;
};

struct StabilityCase {
    const char* id;     ///< "T01"; the letter is its group
    const char* name;   ///< "CriticalAngle": with the id the name of its test
    const char* set_up; ///< what is put in
    const char* oracle; ///< what judges it
    const char* why;    ///< why its limits are what they are
    void (*run)(CaseRun&);
};

/// What a case gave.
struct CaseResult {
    const StabilityCase* subject = nullptr;
    std::deque<Figure> figures;
    double seconds = 0;
    std::string error; ///< what it threw; empty: nothing

    bool holds() const;
};

/// Runs a case; what it throws becomes its error.
CaseResult run_case(const StabilityCase& subject, const ProbeDevice& device, Tier tier);

} // namespace clrt

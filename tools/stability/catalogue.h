// SPDX-License-Identifier: Apache-2.0
// The catalogue of hard cases, group by group, and what the robust choices cost. A new case goes into its
// group's file in cases/.
#pragma once

#include "stability/probe_set.h"
#include "stability/stability_case.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// A group of cases, whose ids begin with its letter.
struct CaseGroup {
    char letter;
    const char* title;
    std::vector<StabilityCase> cases;
};

/// A case that cannot run yet.
struct WaitingCase {
    const char *id, *name, *set_up, *oracle; ///< as those of StabilityCase
    const char* waits_for;
};

/// All groups in the order of the report.
const std::vector<CaseGroup>& catalogue();

/// Whether a case is asked for: its id begins with one of `ids`, or there are none.
bool is_asked_for(const std::string& id, const std::vector<std::string>& ids);

/// What the catalogue will take in once clrt has what it needs, in the order of the report.
const std::vector<WaitingCase>& waiting_cases();

/// The cases of all groups, or those that are asked for.
std::vector<const StabilityCase*> chosen_cases(const std::vector<std::string>& ids = {});

/// Rounds of a timing: enough for quartiles that a disturbed round does not move.
constexpr int CHOICE_ROUNDS = 15;

/// What a robust choice costs: a naive and a robust way to the same figure, timed against each other.
struct RobustChoice {
    const char* choice; ///< "Fresnel near the critical angle"
    const char* naive;
    const char* robust;
    const char* case_id; ///< the case that shows what the naive one gets wrong ...
    int figure = 0;      ///< ... and which of its figures
    ProbeTime (*time)(const ProbeDevice&, int rounds);
};

/// All of them, in the order of the report.
const std::vector<RobustChoice>& robust_choices();

// The groups, each in cases/NAME_cases.cpp.
const std::vector<StabilityCase>& intersection_cases();
const std::vector<StabilityCase>& offsets_cases();
const std::vector<StabilityCase>& scale_cases();
const std::vector<StabilityCase>& degenerate_cases();
const std::vector<StabilityCase>& grazing_cases();
const std::vector<StabilityCase>& dielectric_cases();
const std::vector<StabilityCase>& roughness_cases();
const std::vector<StabilityCase>& furnace_cases();
const std::vector<StabilityCase>& distribution_cases();
const std::vector<StabilityCase>& light_cases();
const std::vector<StabilityCase>& environment_cases();
const std::vector<StabilityCase>& camera_cases();
const std::vector<StabilityCase>& film_cases();
const std::vector<StabilityCase>& bidirectional_cases();
const std::vector<StabilityCase>& sample_cases();
const std::vector<StabilityCase>& device_cases();

} // namespace clrt

// SPDX-License-Identifier: Apache-2.0
#include "options/guide_refusal.h"

namespace clrt {

namespace {

/// Their spread tells the noise that a guide is to lower.
constexpr int FEWEST_GUIDED_REPLICATES = 4;

} // namespace

std::optional<GuideRefusal> guide_refusal(const Options& options) {
    if (!takes_option(options.transport.integrator, TAKES_GUIDE))
        return GuideRefusal{"--integrator", "its paths are not guided"};
    if (options.sampling.first_sample != 0)
        return GuideRefusal{"--first-sample",
                            "guided samples need those before them; render other parts of a "
                            "picture with other seeds"};
    if (options.sampling.adaptive)
        return GuideRefusal{"--adaptive",
                            "its halves decide for each other and must not share what paths have learnt"};
    if (options.sampling.replicates < FEWEST_GUIDED_REPLICATES)
        return GuideRefusal{"--replicates", "the spread of four or more tells what a guide is worth"};
    if (shares_picture(options.device))
        return GuideRefusal{"--device with several names",
                            "guided samples need all those before them, which devices take at once"};
    if (options.run.ledger != LedgerOf::NOTHING)
        return GuideRefusal{"--ledger", "the ledger compares pictures of the same samples"};
    if (options.run.pixel)
        return GuideRefusal{"--pixel", "a guided sample needs all samples before it"};
    return std::nullopt;
}

bool may_guide(const Options& options) {
    return options.transport.guide != Toggle::OFF && !guide_refusal(options);
}

} // namespace clrt

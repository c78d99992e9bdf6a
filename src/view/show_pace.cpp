// SPDX-License-Identifier: Apache-2.0
#include "view/show_pace.h"

#include <algorithm>

namespace clrt {

namespace {

/// Between two pictures: somebody looks on, nothing flickers.
constexpr std::chrono::milliseconds SHORTEST_PAUSE{500};
/// After a picture the render has this many times as long as showing took: it loses a twentieth at most.
constexpr int PAUSE_FACTOR = 19;

} // namespace

void ShowPace::end() {
    end_ = now_();
    pause_ = std::max<Clock::duration>(SHORTEST_PAUSE, PAUSE_FACTOR * (*end_ - begin_));
}

} // namespace clrt

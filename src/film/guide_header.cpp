// SPDX-License-Identifier: Apache-2.0
#include "film/guide_header.h"

#include "film/whole_numbers.h"

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& number) {
    return number ? Json(*number) : Json(nullptr);
}

std::optional<double> read_number(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

/// A number of things of which a guide can have `most`.
size_t read_count(const Json& json, size_t most) {
    const size_t count = whole<size_t>(json);
    if (count > most)
        throw Json::other_error::create(501, "more nodes or cells than a guide can have", &json);
    return count;
}

} // namespace

Json guide_header(const GuideProgress& guide) {
    Json json;
    json["stage"] = int(guide.stage);
    json["epoch"] = guide.epoch;
    json["end"] = guide.end;
    json["guided_from"] = guide.guided_from;
    json["guided_to"] = guide.guided_to;
    json["pilot_error"] = number_or_null(guide.pilot_error);
    json["plain_errors"] = guide.plain_errors;
    json["plain_rays"] = guide.plain_rays;
    json["error"] = number_or_null(guide.error);
    json["work"] = number_or_null(guide.work);
    json["extent"] = guide.guide ? guide.guide->extent() : 0;
    json["nodes"] = guide.guide ? guide.guide->nodes().size() : 0;
    json["cells"] = guide.guide ? guide.guide->lore().size() : 0;
    return json;
}

GuideProgress guide_of_header(const Json& json) {
    GuideProgress guide;
    const int stage = whole<int>(json.at("stage"));
    guide.stage = stage == int(GuideStage::ON)      ? GuideStage::ON
                  : stage == int(GuideStage::PILOT) ? GuideStage::PILOT
                                                    : GuideStage::OFF;
    guide.epoch = whole<u32>(json.at("epoch"));
    guide.end = whole<std::uint64_t>(json.at("end"));
    guide.guided_from = whole<std::uint64_t>(json.at("guided_from"));
    guide.guided_to = whole<std::uint64_t>(json.at("guided_to"));
    guide.pilot_error = read_number(json.at("pilot_error"));
    json.at("plain_errors").get_to(guide.plain_errors);
    json.at("plain_rays").get_to(guide.plain_rays);
    guide.error = read_number(json.at("error"));
    guide.work = read_number(json.at("work"));
    const size_t nodes = read_count(json.at("nodes"), 2 * GUIDE_CELLS),
                 cells = read_count(json.at("cells"), GUIDE_CELLS);
    if (guide.stage == GuideStage::ON) {
        guide.guide.emplace(json.at("extent").get<double>(), std::vector<GuideNode>(nodes),
                            std::vector<GuideLore>(cells));
        guide.sums.resize(cells * GUIDE_SUMS);
    }
    return guide;
}

bool is_possible(const GuideProgress& guide) {
    if (!guide.guide)
        return guide.stage != GuideStage::ON;
    const std::vector<GuideNode>& nodes = guide.guide->nodes();
    const size_t cells = guide.guide->lore().size();
    bool possible = nodes.size() >= GUIDE_SIDES && cells >= GUIDE_SIDES;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const u32 link = nodes[i].link, child = link >> 2;
        if (link & GUIDE_LEAF)
            possible = possible && (link & ~GUIDE_LEAF) < cells;
        else
            possible = possible && (link & 3) < 3 && child > i && child + 1 < nodes.size();
    }
    return possible;
}

} // namespace clrt

// SPDX-License-Identifier: Apache-2.0
#include "film/guide_header.h"

#include "film/whole_numbers.h"

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json number_or_null(const std::optional<T>& number) {
    return number ? Json(*number) : Json(nullptr);
}

std::optional<double> read_number(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

/// Of a picture: 2^16 x 2^16 pixels.
constexpr size_t MOST_TILES = size_t(1) << 26;

/// A number of things of which a guide can have `most`.
size_t read_count(const Json& json, size_t most) {
    const size_t count = whole<size_t>(json);
    if (count > most)
        throw Json::other_error::create(501, "more nodes, cells or tiles than a guide can have", &json);
    return count;
}

} // namespace

Json guide_header(const GuideProgress& guide) {
    Json json;
    json["stage"] = int(guide.stage);
    json["epoch"] = guide.epoch;
    json["begin"] = guide.begin;
    json["end"] = guide.end;
    json["pilot_end"] = guide.pilot_end;
    json["guided_from"] = number_or_null(guide.guided_from);
    json["guided_to"] = guide.guided_to;
    json["pilot_error"] = number_or_null(guide.pilot_error);
    json["plain_error"] = guide.plain_error;
    json["plain_rays"] = guide.plain_rays;
    json["taught_rays"] = guide.taught_rays;
    json["teachers"] = guide.teachers;
    json["begin_error"] = guide.begin_error;
    json["gain"] = guide.gain;
    json["earlier_gain"] = guide.earlier_gain;
    json["asked_from"] = guide.asked_from;
    json["judgements"] = guide.judgements;
    json["weights"] = guide.guide ? guide.weights.size() : 0;
    json["error"] = number_or_null(guide.error);
    json["work"] = number_or_null(guide.work);
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
    guide.begin = whole<std::uint64_t>(json.at("begin"));
    guide.end = whole<std::uint64_t>(json.at("end"));
    guide.pilot_end = whole<std::uint64_t>(json.at("pilot_end"));
    if (const Json& from = json.at("guided_from"); !from.is_null())
        guide.guided_from = whole<std::uint64_t>(from);
    guide.guided_to = whole<std::uint64_t>(json.at("guided_to"));
    guide.pilot_error = read_number(json.at("pilot_error"));
    json.at("plain_error").get_to(guide.plain_error);
    json.at("plain_rays").get_to(guide.plain_rays);
    json.at("taught_rays").get_to(guide.taught_rays);
    guide.teachers = whole<u32>(json.at("teachers"));
    json.at("begin_error").get_to(guide.begin_error);
    json.at("gain").get_to(guide.gain);
    json.at("earlier_gain").get_to(guide.earlier_gain);
    guide.asked_from = whole<std::uint64_t>(json.at("asked_from"));
    guide.judgements = whole<u32>(json.at("judgements"));
    guide.error = read_number(json.at("error"));
    guide.work = read_number(json.at("work"));
    const size_t nodes = read_count(json.at("nodes"), 2 * GUIDE_CELLS),
                 cells = read_count(json.at("cells"), GUIDE_CELLS);
    if (guide.stage == GuideStage::ON) {
        guide.guide.emplace(std::vector<u32>(nodes), std::vector<GuideLore>(cells));
        guide.sums.resize(cells * GUIDE_SUMS);
        guide.weights.resize(read_count(json.at("weights"), MOST_TILES));
    }
    return guide;
}

bool is_possible(const GuideProgress& guide) {
    if (!guide.guide)
        return guide.stage != GuideStage::ON;
    const std::vector<u32>& nodes = guide.guide->nodes();
    const size_t cells = guide.guide->lore().size();
    bool possible = nodes.size() >= GUIDE_SIDES && cells >= GUIDE_SIDES;
    for (size_t i = 0; i < nodes.size(); ++i)
        possible = possible && (nodes[i] & GUIDE_LEAF ? (nodes[i] & ~GUIDE_LEAF) < cells
                                                      : nodes[i] > i && size_t(nodes[i]) + 1 < nodes.size());
    return possible;
}

} // namespace clrt

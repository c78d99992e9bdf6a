// SPDX-License-Identifier: Apache-2.0
// The record of --pixel as JSON.
#include "replay/causes.h"
#include "replay/replay_command.h"
#include "replay/replay_report.h"
#include "replay/replay_values.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

Json event_json(const SampleTrace& trace, const TraceEvent& event, const Scene& scene) {
    Json json{{"quantity", quantity(event.quantity).key}};
    if (is_choice(event.quantity)) {
        json["value"] = event.quantity == TRACE_TRIANGLE && event.bits[0] == NO_INDEX ? Json(nullptr)
                                                                                      : Json(event.bits[0]);
        json["meaning"] = choice_text(event, scene);
        return json;
    }
    const std::vector<double> values = event_values(trace, event, scene);
    const std::vector<std::string> hex = event_hex(trace, event);
    json["value"] = values.size() == 1 ? Json(values[0]) : Json(values);
    json["hex"] = hex.size() == 1 ? Json(hex[0]) : Json(hex);
    return json;
}

Json trace_json(const SampleTrace& trace, const Scene& scene, double quantum) {
    Json json{{"precision", name_of(trace.precision)}, {"fault", nullptr}, {"film", Json::array()}};
    if (trace.fault != COUNT_WORDS)
        json["fault"] = fault_name(trace.fault);
    for (const std::int64_t sum : trace.film)
        json["film"].push_back(double(sum) * quantum);
    json["vertices"] = Json::array();
    for (const TraceEvent& event : trace.events) {
        if (event.quantity == TRACE_RADIANCE) {
            json["radiance"] = event_json(trace, event, scene);
        } else if (event.quantity == TRACE_VERTEX) {
            json["vertices"].push_back(
                {{"bounce", event.bits[0]}, {"node", event.bits[1]}, {"events", Json::array()}});
        } else if (event.quantity == TRACE_LAYER) {
            json["layers"].push_back(event_json(trace, event, scene));
        } else if (!json["vertices"].empty())
            json["vertices"].back()["events"].push_back(event_json(trace, event, scene));
    }
    return json;
}

Json difference_json(const ReplayReport& report) {
    if (!report.twin)
        return nullptr;
    const TwinDifference difference = compare_twins(report.first, *report.twin);
    Json json{{"decision", nullptr}, {"largest", nullptr}};
    if (difference.has_decision()) {
        const size_t at = difference.decision;
        json["decision"] = {{"bounce", trace_bounce(report.first, at > 0 ? at - 1 : 0)},
                            {"quantity", decision_name(report.first, *report.twin, at)}};
    }
    if (difference.has_largest())
        json["largest"] = {{"bounce", trace_bounce(report.first, difference.largest)},
                           {"quantity", quantity(report.first.events[difference.largest].quantity).key},
                           {"relative", difference.largest_relative}};
    return json;
}

} // namespace

std::string replay_json(const ReplayReport& report) {
    const u32 width = u32(report.options.film.size.x), pixel = report.first.address.pixel;
    Json json;
    json["version"] = CLRT_VERSION;
    json["command"] = shell_text(report.options.run.command);
    json["integrator"] = name_of(report.options.transport.integrator);
    json["device"] = {
        {"platform", report.device.platform}, {"name", report.device.name}, {"driver", report.device.driver}};
    json["pixel"] = {pixel % width, pixel / width};
    json["sample"] = report.first.address.sample;
    json["scale"] = report.scene.normalisation.scale;
    const auto& centre = report.scene.normalisation.centre;
    json["centre"] = {centre.x, centre.y, centre.z};
    json["traces"] = Json::array();
    json["traces"].push_back(trace_json(report.first, report.scene, report.quantum));
    if (report.twin)
        json["traces"].push_back(trace_json(*report.twin, report.scene, report.quantum));
    json["difference"] = difference_json(report);
    return json.dump(2) + "\n";
}

} // namespace clrt

// SPDX-License-Identifier: Apache-2.0
#include "device/device_facts.h"

#include "device/fact_operands.h"
#include "device/kernel_source.h"
#include "device/program_cache.h"
#include "error.h"
#include "kernels/shared/fact_types.h"
#include "output/image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <xxhash.h>

namespace clrt {

namespace {

/// The one rule that no kernel needs: none has a loop that a compiler could sum in another order.
const char* const ORDER_RULE = "sums in order";

/// XXH3 of the results of real_functions.h on the operands of fact_operands.h. Fixed by the text of both.
constexpr std::uint64_t FUNCTIONS_DIGEST = 0x9e3999893367e7b2;

/// What the device answered.
struct Answers {
    std::vector<float> results;
    unsigned rules = 0;

    const float* array(size_t which) const { return results.data() + which * FACT_COUNT; }
};

ProgramRequest facts_request() {
    ProgramRequest request;
    request.name = "device_facts";
    request.source = expand_kernel_source(embedded_kernel_files(), "numerics/device_facts.cl");
    request.cache.use = Toggle::OFF; // what is kept are the facts
    return request;
}

Answers ask(const Device& device, const FactOperands& operands) {
    const Program program = build_program(device, facts_request());
    Kernel kernel(program, "device_facts");
    kernel.set("a", upload_buffer(device, "facts a", operands.a));
    kernel.set("b", upload_buffer(device, "facts b", operands.b));
    kernel.set("c", upload_buffer(device, "facts c", operands.c));
    kernel.set("squares", upload_buffer(device, "facts squares", operands.squares));
    kernel.set("units", upload_buffer(device, "facts units", operands.units));
    kernel.set("numbers", upload_buffer(device, "facts numbers", operands.numbers));
    Answers answers;
    answers.results.resize(size_t(FACT_ARRAYS) * FACT_COUNT);
    const size_t bytes = answers.results.size() * sizeof(float);
    const cl::Buffer results = create_buffer(device, "facts results", bytes);
    const cl::Buffer rules = create_buffer(device, "facts rules", sizeof answers.rules);
    kernel.set("results", results);
    kernel.set("rules", rules);
    check_opencl("asking the device how it computes", [&] {
        device.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange, cl::NDRange(FACT_COUNT / 8));
        device.queue.enqueueReadBuffer(results, CL_TRUE, 0, bytes, answers.results.data());
        device.queue.enqueueReadBuffer(rules, CL_TRUE, 0, sizeof answers.rules, &answers.rules);
    });
    return answers;
}

/// Whether an array holds the floats nearest to a function of the operand's index, computed in double; what
/// is correctly rounded there is so after rounding to float once more (Figueroa 1995).
template <class Function>
bool is_rounded(const Answers& answers, size_t which, Function exact) {
    const float* got = answers.array(which);
    for (size_t i = 0; i < FACT_COUNT; ++i)
        if (got[i] != static_cast<float>(exact(i)))
            return false;
    return true;
}

/// Largest error against a function of the operand's index.
template <class Function>
double largest_ulp(const Answers& answers, size_t which, Function exact) {
    double worst = 0;
    for (size_t i = 0; i < FACT_COUNT; ++i) {
        const double reference = exact(i);
        const int exponent = reference == 0 ? -126 : std::max(std::ilogb(reference), -126);
        const double error = std::abs(answers.array(which)[i] - reference) / std::ldexp(1.0, exponent - 23);
        worst = std::isnan(error) ? INFINITY : std::max(worst, error);
    }
    return worst;
}

/// The product rounded to float.
double product(float x, float y) {
    return static_cast<float>(double(x) * y);
}

void judge_operations(const Answers& answers, const FactOperands& o, DeviceFacts& facts) {
    const auto quotient = [&](size_t i) { return double(o.a[i]) / o.b[i]; };
    const auto root = [&](size_t i) { return std::sqrt(double(o.squares[i])); };
    const auto fused = [&](size_t i) { return std::fma(o.a[i], o.b[i], o.c[i]); };
    const auto kept = [&](size_t which_one, size_t which_eight, auto exact) {
        return is_rounded(answers, which_one, exact) && is_rounded(answers, which_eight, exact);
    };
    facts.rules.emplace_back("division rounded correctly", kept(FACT_DIVISION, FACT_DIVISION_8, quotient));
    facts.rules.emplace_back("square root rounded correctly", kept(FACT_ROOT, FACT_ROOT_8, root));
    facts.rules.emplace_back("fma rounded once", kept(FACT_FMA, FACT_FMA_8, fused));
    facts.rules.emplace_back(
        "products and sums not fused",
        is_rounded(answers, FACT_PRODUCT_SUM, [&](size_t i) { return product(o.a[i], o.b[i]) + o.c[i]; }) &&
            is_rounded(answers, FACT_PRODUCT_DIFFERENCE,
                       [&](size_t i) { return product(o.a[i], o.b[i]) - product(o.c[i], o.b[i]); }));
    facts.rules.emplace_back("subnormal numbers", is_rounded(answers, FACT_SUBNORMAL, [&](size_t i) {
                                 return product(static_cast<float>(product(o.a[i], 1.0e-38f)), 1.0e-4f);
                             }));
    facts.errors_ulp.emplace_back("division", largest_ulp(answers, FACT_DIVISION, quotient));
    facts.errors_ulp.emplace_back("square root", largest_ulp(answers, FACT_ROOT, root));
}

void judge_rules(const Answers& answers, DeviceFacts& facts) {
    facts.rules.emplace_back("NaN", (answers.rules & FACT_RULE_NAN) != 0);
    facts.rules.emplace_back("infinity", (answers.rules & FACT_RULE_INFINITE) != 0);
    facts.rules.emplace_back("sign of zero", (answers.rules & FACT_RULE_ZERO) != 0);
    facts.rules.emplace_back("conversions", (answers.rules & FACT_RULE_CONVERSION) != 0);
}

void judge_functions(const Answers& answers, const FactOperands& o, DeviceFacts& facts) {
    const auto error = [&](const char* name, size_t which, auto exact) {
        facts.errors_ulp.emplace_back(name, largest_ulp(answers, which, exact));
    };
    const double pi = std::acos(-1.0);
    const auto turn = [&](size_t i) { return 2 * pi * double(o.units[i]); };
    error("exp", FACT_EXP, [&](size_t i) { return std::exp(double(std::fma(o.units[i], 190.0f, -103.0f))); });
    error("log", FACT_LOG, [&](size_t i) { return std::log(double(o.squares[i])); });
    error("pow", FACT_POW, [&](size_t i) { return std::pow(double(o.units[i]), std::abs(double(o.c[i]))); });
    error("atan2", FACT_ATAN2, [&](size_t i) { return std::atan2(double(o.a[i]), double(o.b[i])); });
    error("acos", FACT_ACOS, [&](size_t i) { return std::acos(double(std::fma(o.units[i], 2.0f, -1.0f))); });
    error("sin of a turn", FACT_SIN_TURN, [&](size_t i) { return std::sin(turn(i)); });
    error("cos of a turn", FACT_COS_TURN, [&](size_t i) { return std::cos(turn(i)); });
    const size_t count = size_t(FACT_ARRAYS - FACT_EXP) * FACT_COUNT;
    const std::uint64_t digest = XXH3_64bits(answers.array(FACT_EXP), count * sizeof(float));
    facts.rules.emplace_back("functions of fixed bits", digest == FUNCTIONS_DIGEST);
}

float sum_in_order(const FactOperands& operands, size_t first) {
    float sum = 0;
    for (size_t term = 0; term < FACT_SUM_TERMS; ++term)
        sum = static_cast<float>(double(sum) + operands.c[(first + term) % FACT_COUNT]);
    return sum;
}

/// The facts that a run before this has kept; false if there are none.
bool read_facts(const std::string& path, DeviceFacts& facts) {
    std::ifstream file(path);
    if (!file)
        return false;
    try {
        facts = facts_from_json(nlohmann::ordered_json::parse(file));
        return !facts.rules.empty();
    } catch (const nlohmann::json::exception&) {
        spdlog::debug("{} is damaged or not ours; the device is asked again.", path);
        return false;
    }
}

void keep_facts(const std::string& path, const DeviceFacts& facts) {
    try {
        std::filesystem::create_directories(std::filesystem::path(path).parent_path());
        write_text_file(path, facts_json(facts).dump(2) + "\n");
    } catch (const std::exception& error) {
        spdlog::debug("The facts of the device are not kept: {}", error.what());
    }
}

} // namespace

DeviceFacts measure_device_facts(const Device& device) {
    const FactOperands operands = make_fact_operands();
    const Answers answers = ask(device, operands);
    DeviceFacts facts;
    judge_operations(answers, operands, facts);
    judge_rules(answers, facts);
    judge_functions(answers, operands, facts);
    facts.rules.emplace_back(
        ORDER_RULE, is_rounded(answers, FACT_SUM, [&](size_t i) { return sum_in_order(operands, i); }));
    return facts;
}

DeviceFacts device_facts(const Device& device, const ProgramCache& cache) {
    const std::string folder = cache.use == Toggle::OFF ? std::string() : program_cache_folder(cache);
    if (folder.empty())
        return measure_device_facts(device);
    const ProgramRequest request = facts_request();
    const std::string path =
        (std::filesystem::path(folder) /
         (program_cache_key(device.info, request.source, build_options(device.info, request.precision)) +
          ".facts.json"))
            .string();
    DeviceFacts facts;
    if (!read_facts(path, facts)) {
        facts = measure_device_facts(device);
        keep_facts(path, facts);
    }
    return facts;
}

std::vector<std::string> broken_rules(const DeviceFacts& facts) {
    std::vector<std::string> broken;
    for (const auto& [name, holds] : facts.rules)
        if (!holds && name != ORDER_RULE)
            broken.push_back(name);
    return broken;
}

bool promises_bits(const DeviceFacts& facts) {
    return !facts.rules.empty() && broken_rules(facts).empty();
}

std::string describe_facts(const DeviceFacts& facts) {
    std::vector<std::string> errors, broken;
    for (const auto& [name, ulp] : facts.errors_ulp)
        errors.push_back(fmt::format("{} {:.2f}", name, ulp));
    for (const auto& [name, holds] : facts.rules)
        if (!holds)
            broken.push_back(name);
    return fmt::format("largest errors in ulp: {}; {}", fmt::join(errors, ", "),
                       broken.empty() ? "every rule kept"
                                      : fmt::format("not kept: {}", fmt::join(broken, ", ")));
}

std::string format_facts(const std::vector<PlatformInfo>& platforms, const ProgramCache& cache) {
    std::string text;
    for (const PlatformInfo& platform : platforms)
        for (const DeviceInfo& info : platform.devices) {
            text += fmt::format("\n{}:{}  ", info.platform_index, info.device_index);
            try {
                const DeviceFacts facts = device_facts(open_device(info), cache);
                text += fmt::format("{}\n     {}\n",
                                    promises_bits(facts)
                                        ? "gives the same bits as every device that keeps the rules"
                                        : "may differ from other devices in the last bits",
                                    describe_facts(facts));
            } catch (const DeviceError& error) {
                text += fmt::format("cannot be asked: {}\n", error.what());
            }
        }
    return text;
}

nlohmann::ordered_json facts_json(const DeviceFacts& facts) {
    nlohmann::ordered_json json{{"rules", nlohmann::ordered_json::object()},
                                {"errors_ulp", nlohmann::ordered_json::object()}};
    for (const auto& [name, holds] : facts.rules)
        json["rules"][name] = holds;
    for (const auto& [name, ulp] : facts.errors_ulp)
        json["errors_ulp"][name] =
            std::isfinite(ulp) ? nlohmann::ordered_json(ulp) : nlohmann::ordered_json(nullptr);
    return json;
}

DeviceFacts facts_from_json(const nlohmann::ordered_json& json) {
    DeviceFacts facts;
    for (const auto& [name, holds] : json.at("rules").items())
        facts.rules.emplace_back(name, holds.get<bool>());
    for (const auto& [name, ulp] : json.at("errors_ulp").items())
        facts.errors_ulp.emplace_back(name, ulp.is_null() ? INFINITY : ulp.get<double>());
    return facts;
}

} // namespace clrt

// SPDX-License-Identifier: Apache-2.0
// clrt-bench: clrt's rays against Embree's.
#include "app/log.h"
#include "app/run_program.h"
#include "bench/report.h"
#include "bench/speed.h"
#include "error.h"
#include "exit_code.h"
#include "output/image.h"
#include "render/kernels.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <new>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

namespace clrt {

namespace {

/// The device that the options name, open.
Device open_bench_device(const BenchOptions& bench) {
    set_driver_environment(bench.clrt.device);
    std::string notice;
    const DeviceInfo info = choose_device(list_platforms(), bench.clrt.device.name, notice);
    if (!notice.empty())
        spdlog::info("{}", notice);
    return open_device(info);
}

int run_speed(const BenchOptions& bench) {
    const Device device = open_bench_device(bench);
    Progress progress(Toggle::AUTO, /*quiet=*/false);
    std::vector<SceneSpeed> scenes;
    for (const std::string& path : bench.scenes) {
        scenes.push_back(compare_speed(device, bench, path, progress));
        fmt::print("{}{}", scenes.size() > 1 ? "\n" : "", format_speed(scenes.back(), bench.cpu_time));
        std::fflush(stdout);
    }
    if (!bench.stats_path.empty())
        write_text_file(bench.stats_path, speed_json(bench, device.info, scenes));
    return std::any_of(scenes.begin(), scenes.end(), [](const SceneSpeed& scene) { return is_wrong(scene); })
               ? EXIT_CHECK
               : EXIT_DONE;
}

int run_trees(const BenchOptions& bench) {
    set_driver_environment(bench.clrt.device);
    std::string notice;
    const DeviceInfo device = choose_device(list_platforms(), bench.clrt.device.name, notice);
    Progress progress(Toggle::AUTO, /*quiet=*/false);
    std::vector<SceneTrees> scenes;
    for (const std::string& path : bench.scenes) {
        scenes.push_back(compare_trees(bench, path, choose_layout(bench.clrt.bvh.layout, device), progress));
        fmt::print("{}{}", scenes.size() > 1 ? "\n" : "", format_trees(scenes.back()));
        std::fflush(stdout);
    }
    if (!bench.stats_path.empty())
        write_text_file(bench.stats_path, trees_json(bench, device, scenes));
    return EXIT_DONE;
}

int run_watertight_check(const BenchOptions& bench) {
    const Device device = open_bench_device(bench);
    Progress progress(Toggle::AUTO, /*quiet=*/false);
    WatertightRequest request;
    if (bench.aimed_rays > 0)
        request.rays = bench.aimed_rays;
    request.layout = choose_layout(bench.clrt.bvh.layout, device.info);
    request.files = all_kernel_files(bench.clrt.device.kernels_folder);
    std::vector<WatertightCase> cases;
    const Cost cost = measure([&] {
        cases = run_watertight(device, request, [&](double share) {
            progress.update({"aimed rays", share});
        });
    });
    progress.finish();
    fmt::print("{}", format_watertight(cases));
    fmt::print("{:.1f} s; lost rays: {}\n", cost.wall, count_lost(cases));
    if (!bench.stats_path.empty())
        write_text_file(bench.stats_path, watertight_json(bench, device.info, cases, cost.wall));
    return count_lost(cases) > 0 ? EXIT_CHECK : EXIT_DONE;
}

int run_robustness(const BenchOptions& bench) {
    const Device device = open_bench_device(bench);
    Progress progress(Toggle::AUTO, /*quiet=*/false);
    std::vector<Robustness> scenes;
    for (const std::string& path : bench.scenes.empty() ? std::vector<std::string>{""} : bench.scenes) {
        scenes.push_back(compare_robustness(device, bench, path, progress));
        fmt::print("{}{}", scenes.size() > 1 ? "\n" : "", format_robustness(scenes.back(), bench.cpu_time));
        std::fflush(stdout);
    }
    if (!bench.stats_path.empty())
        write_text_file(bench.stats_path, robustness_json(bench, device.info, scenes));
    return std::any_of(scenes.begin(), scenes.end(), [](const Robustness& scene) { return is_wrong(scene); })
               ? EXIT_CHECK
               : EXIT_DONE;
}

int run_mode(const BenchOptions& bench) {
    switch (bench.mode) {
    case BenchMode::TREES:
        return run_trees(bench);
    case BenchMode::WATERTIGHT:
        return run_watertight_check(bench);
    case BenchMode::ROBUSTNESS:
        return run_robustness(bench);
    case BenchMode::SPEED:
        break;
    }
    return run_speed(bench);
}

int run(int argc, const char* const* argv) {
    const BenchOptions bench = parse_bench_options(argc, argv);
    if (bench.print) {
        fmt::print("{}", *bench.print);
        return EXIT_DONE;
    }
    start_log(0);
    std::unique_ptr<tbb::global_control> limit;
    if (bench.clrt.device.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      size_t(bench.clrt.device.threads));
    return run_mode(bench);
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt-bench", [&] { return run(argc, argv); });
}

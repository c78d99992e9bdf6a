// SPDX-License-Identifier: Apache-2.0
// clrt-bench: clrt's rays against Embree's.
#include "app/log.h"
#include "bench/report.h"
#include "bench/speed.h"
#include "error.h"
#include "exit_code.h"
#include "output/image.h"

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
    Options options;
    options.threads = bench.threads;
    set_driver_environment(options);
    std::string notice;
    const DeviceInfo info = choose_device(list_platforms(), bench.device, notice);
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
    return std::any_of(scenes.begin(), scenes.end(), is_wrong) ? EXIT_CHECK : EXIT_DONE;
}

int run(int argc, const char* const* argv) {
    const BenchOptions bench = parse_bench_options(argc, argv);
    if (bench.print) {
        fmt::print("{}", *bench.print);
        return EXIT_DONE;
    }
    start_log(0);
    std::unique_ptr<tbb::global_control> limit;
    if (bench.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      size_t(bench.threads));
    return run_speed(bench);
}

int report_error(int code, const char* what) {
    std::fprintf(stderr, "clrt-bench: error: %s\n", what);
    return code;
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    try {
        return run(argc, argv);
    } catch (const UsageError& error) {
        return report_error(EXIT_USAGE, error.what());
    } catch (const SceneError& error) {
        return report_error(EXIT_SCENE, error.what());
    } catch (const DeviceError& error) {
        return report_error(EXIT_DEVICE, error.what());
    } catch (const std::bad_alloc&) {
        return report_error(EXIT_SCENE, "not enough memory");
    } catch (const std::exception& error) {
        return report_error(EXIT_SCENE, error.what());
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "device/compile_ahead.h"

#include "device/program_cache.h"
#include "kernels/shared/render_types.h"
#include "seconds.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// A cached program is there sooner.
constexpr std::chrono::milliseconds PATIENCE{400};
/// Each takes some 200 MB.
constexpr unsigned MOST_PROCESSES = 3;

nlohmann::json program_json(const ProgramRequest& request) {
    return {{"name", request.name},
            {"source", request.source},
            {"defines", request.defines},
            {"precision", int(request.precision)},
            {"cache", int(request.cache.use)},
            {"cache_folder", request.cache.folder}};
}

std::string program_text(const ProgramRequest& request) {
    return program_json(request).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ProgramRequest program_from(const nlohmann::json& json) {
    ProgramRequest request;
    request.name = json.at("name");
    request.source = json.at("source");
    request.defines = json.at("defines").get<std::vector<std::string>>();
    request.precision = Precision(json.at("precision").get<int>());
    request.cache = {Toggle(json.at("cache").get<int>()), json.at("cache_folder")};
    return request;
}

/// Both ends of a stream; the second becomes a process's stdin.
struct Stream {
    int ends[2] = {-1, -1};
    Stream() {
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            ends[0] = ends[1] = -1;
    }
    ~Stream() {
        close_end(0);
        close_end(1);
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    void close_end(int end) {
        if (ends[end] >= 0)
            close(ends[end]);
        ends[end] = -1;
    }
};

/// Starts a process that reads from the stream and says nothing; 0: it cannot be started.
pid_t start_process(const std::string& path, const Stream& stream) {
    posix_spawn_file_actions_t actions;
    if (stream.ends[1] < 0 || posix_spawn_file_actions_init(&actions) != 0)
        return 0;
    posix_spawn_file_actions_adddup2(&actions, stream.ends[1], STDIN_FILENO);
    for (const int said : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, said, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    std::string name = path;
    char* const arguments[] = {name.data(), nullptr};
    pid_t process = 0;
    const int error = posix_spawn(&process, path.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return error == 0 ? process : 0;
}

/// Sends all of a text; a reader that has gone is no matter.
void send_text(int to, const std::string& text) {
    for (size_t sent = 0; sent < text.size();) {
        const ssize_t more = send(to, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (more < 0 && errno != EINTR)
            return;
        sent += size_t(std::max<ssize_t>(more, 0));
    }
}

/// Waits for the end of a process, which may still be signalled then, until it is reaped.
void wait_for_end(pid_t process) {
    siginfo_t info;
    while (waitid(P_PID, id_t(process), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
    }
}

unsigned usable_processors() {
    cpu_set_t processors;
    if (sched_getaffinity(0, sizeof processors, &processors) != 0)
        return 1;
    return unsigned(CPU_COUNT(&processors));
}

/// Whether what another process compiles will be found.
bool keeps_programs(const DeviceInfo& device, const ProgramCache& cache) {
    if (cache.use == Toggle::OFF)
        return false;
    if (uses_program_cache(cache, device))
        return !program_cache_folder(cache).empty() && program_cache_obstacle(cache).empty();
    const char* const pocl = std::getenv("POCL_KERNEL_CACHE");
    return driver_caches_programs(device) && !(pocl && std::string(pocl) == "0");
}

} // namespace

CompileAhead::CompileAhead(const DeviceInfo& device, std::string helper, unsigned processes)
    : device_(device), helper_(std::move(helper)), processes_(processes) {}

CompileAhead::~CompileAhead() {
    forget_all_but(std::string());
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
    for (std::thread& worker : workers_)
        worker.join();
}

void CompileAhead::expect(const ProgramRequest& request, const std::string& kernel) {
    const nlohmann::json json = {{"platform", device_.platform_index},
                                 {"device", device_.device_index},
                                 {"kernel", kernel},
                                 {"program", program_json(request)}};
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
        const std::string program = program_text(request);
        if (std::any_of(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.program == program; }))
            return;
        jobs_.push_back({request.name, program, json.dump()});
    } catch (const nlohmann::json::type_error&) { // the cache's folder has a name that is no UTF-8
        return;
    }
    try {
        if (workers_.size() < std::min<size_t>(processes_ + 1, jobs_.size()))
            workers_.emplace_back([this] { work(); });
    } catch (const std::system_error&) { // no thread to be had: then it is compiled when it is wanted
    }
    changed_.notify_all();
}

std::unique_ptr<CompileAhead::Turn> CompileAhead::take(const ProgramRequest& request) {
    const std::string program = program_text(request);
    {
        std::unique_lock<std::mutex> lock(mutex_);
        for (Job& job : jobs_) {
            if (job.program != program)
                continue;
            if (job.stage == Stage::WAITING)
                job.stage = Stage::DONE;
            ++waiting_;
            changed_.notify_all();
            changed_.wait(lock, [&] { return job.stage == Stage::DONE; });
            --waiting_;
        }
    }
    return std::make_unique<Turn>(*this);
}

CompileAhead::Turn::Turn(CompileAhead& ahead) : ahead_(ahead) {
    const std::lock_guard<std::mutex> lock(ahead_.mutex_);
    if (ahead_.builders_++ == 0)
        ahead_.begun_ = std::chrono::steady_clock::now();
    ahead_.changed_.notify_all();
}

CompileAhead::Turn::~Turn() {
    const std::lock_guard<std::mutex> lock(ahead_.mutex_);
    if (--ahead_.builders_ == 0)
        ahead_.begun_.reset();
}

void CompileAhead::forget_all_but(const ProgramRequest& request) {
    forget_all_but(program_text(request));
}

void CompileAhead::forget_all_but(const std::string& program) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Job& job : jobs_) {
        if (job.program == program)
            continue;
        job.program.clear();
        if (job.stage == Stage::RUNNING)
            kill(job.process, SIGKILL);
        else
            job.stage = Stage::DONE;
    }
}

unsigned CompileAhead::started() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return started_;
}

/// The next job, once somebody has compiled for long and a process may run; null at the end.
CompileAhead::Job* CompileAhead::next_job(std::unique_lock<std::mutex>& lock) {
    while (!is_over_) {
        const auto now = std::chrono::steady_clock::now();
        is_needed_ = is_needed_ || (begun_ && now >= *begun_ + PATIENCE);
        const auto job = std::find_if(jobs_.rbegin(), jobs_.rend(),
                                      [](const Job& each) { return each.stage == Stage::WAITING; });
        if (is_needed_ && job != jobs_.rend() && running_ < processes_ + waiting_)
            return &*job;
        if (!is_needed_ && begun_)
            changed_.wait_until(lock, *begun_ + PATIENCE);
        else
            changed_.wait(lock);
    }
    return nullptr;
}

/// Has a process do a job; the lock is open while it runs.
void CompileAhead::run(Job& job, std::unique_lock<std::mutex>& lock) {
    const auto start = std::chrono::steady_clock::now();
    Stream stream;
    job.process = start_process(helper_, stream);
    job.stage = job.process != 0 ? Stage::RUNNING : Stage::DONE;
    if (job.stage == Stage::RUNNING) {
        ++started_;
        ++running_;
        lock.unlock();
        stream.close_end(1);
        send_text(stream.ends[0], job.text);
        stream.close_end(0);
        wait_for_end(job.process);
        lock.lock();
        --running_;
        job.stage = Stage::DONE;
        int status = 0;
        waitpid(job.process, &status, 0);
        if (status == 0)
            spdlog::debug("the program {} was compiled ahead in {:.1f} s", job.name, seconds_since(start));
    }
    changed_.notify_all();
}

void CompileAhead::work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (Job* const job = next_job(lock))
        run(*job, lock);
}

std::string compile_helper() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    if (error)
        return {};
    for (const fs::path& path : {folder / "clrt-compile", folder / "../lib/clrt/clrt-compile"})
        if (access(path.c_str(), X_OK) == 0)
            return path.string();
    return {};
}

std::shared_ptr<CompileAhead> compile_ahead(const DeviceInfo& device, const ProgramCache& cache,
                                            unsigned processors) {
    const unsigned usable = usable_processors();
    const unsigned processes =
        std::min((processors == 0 ? usable : std::min(processors, usable)) - 1, MOST_PROCESSES);
    const std::string helper =
        keeps_programs(device, cache) && processes > 0 ? compile_helper() : std::string();
    return helper.empty() ? nullptr : std::make_shared<CompileAhead>(device, helper, processes);
}

void compile_from_text(const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    const size_t platform = json.at("platform"), index = json.at("device");
    const std::string name = json.at("kernel");
    const Device device = open_device(list_platforms().at(platform).devices.at(index));
    const Program program = build_program(device, program_from(json.at("program")));
    Kernel kernel(program, name);
    for (const auto& argument : program.arguments.at(name)) {
        if (argument.first == "params")
            kernel.set("params", RenderParams{}); // no tile of no picture
        else
            kernel.set(argument.first, cl::Buffer());
    }
    check_opencl("launching " + name, [&] {
        device.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange, cl::NDRange(TILE_SIZE, TILE_SIZE),
                                          cl::NDRange(TILE_SIZE, TILE_SIZE));
        device.queue.finish();
    });
}

} // namespace clrt

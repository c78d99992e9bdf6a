// SPDX-License-Identifier: Apache-2.0
// Programs that will be wanted soon, compiled by other processes meanwhile. Drivers compile one program at a
// time in a process, however many threads and contexts ask (PoCL 3.1), and seconds each; what another process
// has compiled is then found in the driver's cache, or in ours.
#pragma once

#include "device/device.h"
#include "device/program.h"

#include <chrono>
#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

namespace clrt {

/// Compiles ahead for one device. Nothing is started before a program that somebody waits for turns out not
/// to be cached: it is compiled for long. Any thread may call. What is compiled decides about seconds only.
class CompileAhead {
public:
    /// `helper`: the path of clrt-compile, of which at most so many processes run at once, and another in the
    /// place of each thread that waits for one.
    CompileAhead(const DeviceInfo& device, std::string helper, unsigned processes);
    /// Ends the processes.
    ~CompileAhead();
    CompileAhead(const CompileAhead&) = delete;
    CompileAhead& operator=(const CompileAhead&) = delete;

    /// Has a program compiled, and a kernel of it, before those that were expected earlier and still wait:
    /// what is known later is surer.
    void expect(const ProgramRequest& request, const std::string& kernel);

    /// While it lives, somebody compiles.
    class Turn {
    public:
        explicit Turn(CompileAhead& ahead);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

    private:
        CompileAhead& ahead_;
    };

    /// To be held while this program is built: returns when the process that compiles it has ended; if there
    /// is none yet, it is expected no more.
    std::unique_ptr<Turn> take(const ProgramRequest& request);

    /// Of the programs expected so far none but this is wanted any more.
    void forget_all_but(const ProgramRequest& request);

    /// Processes that were started, for tests.
    unsigned started() const;

private:
    enum class Stage { WAITING, RUNNING, DONE };
    struct Job {
        std::string name;    ///< for messages
        std::string program; ///< what it is known by; empty: it was forgotten
        std::string text;    ///< what the process reads
        Stage stage = Stage::WAITING;
        pid_t process = 0;
    };
    void forget_all_but(const std::string& program);
    void work();
    Job* next_job(std::unique_lock<std::mutex>& lock);
    void run(Job& job, std::unique_lock<std::mutex>& lock);

    DeviceInfo device_;
    std::string helper_;
    unsigned processes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::list<Job> jobs_;                                        ///< grows only
    int builders_ = 0;                                           ///< that compile now
    unsigned waiting_ = 0;                                       ///< for a process
    unsigned running_ = 0;                                       ///< processes
    std::optional<std::chrono::steady_clock::time_point> begun_; ///< when the first of them began
    bool is_needed_ = false, is_over_ = false;
    unsigned started_ = 0;
    std::vector<std::thread> workers_;
};

/// Where clrt-compile is: beside the running program, or installed with it. Empty: nowhere.
std::string compile_helper();

/// For a device of a run on so many processors (0: all), or null: where compiled programs are not kept, with
/// one processor, and without clrt-compile.
std::shared_ptr<CompileAhead> compile_ahead(const DeviceInfo& device, const ProgramCache& cache,
                                            unsigned processors);

/// What clrt-compile does with the text that it reads: builds the program, and launches the kernel without
/// work, for some drivers compile it no earlier. Throws std::exception.
void compile_from_text(const std::string& text);

} // namespace clrt

#include "host/batch/batch.h"

#include "host/batch/frame_stages.h"
#include "host/batch/memory.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <utility>

namespace clshade {

namespace {

/// What the compiler of kernels takes for a while, and what else comes with the first frame.
constexpr std::uint64_t start_memory = std::uint64_t{256} << 20U;
/// Frames under way beyond one for each thread: one waits, for the device or for the medium. A second would cost more
/// in fresh memory than it gains.
constexpr std::uint64_t frames_waiting = 1;

/// Where nothing is packed, workers stand still for the medium and for kernels on the driver's threads as long as they
/// work: one more of them keeps all processors busy, provided that all may be used, else --threads is a promise. Where
/// they pack, it would only be in their way (48 to 60 frames on two cores: plain half 5 % quicker with it, half DWA 2 %
/// slower).
std::size_t workers_for(const BatchSettings& settings) {
    const auto wanted = static_cast<std::size_t>(std::max(settings.threads, 1));
    const bool all = wanted > 1 && wanted >= std::thread::hardware_concurrency();
    return all && settings.exr.compression == "none" ? wanted + 1 : wanted;
}

using WorkPointer = std::unique_ptr<FrameWork>;

/// The jobs of a run, planned one after the other, shaded many at a time.
class BatchRun {
  public:
    BatchRun(std::span<const FrameJob> jobs, const RunScene& scene, const BatchSettings& settings,
             BatchResources& resources, BatchListener& listener)
        : jobs_(jobs), settings_(settings), listener_(listener), stages_(scene, settings, resources, listener),
          limit_(settings.max_memory > 0 ? settings.max_memory : machine_memory() / 2),
          base_(resident_memory() + start_memory) {}

    void run() {
        while (WorkPointer work = next()) {
            if (!work->open()) {
                report(std::move(work));
                continue;
            }
            const std::uint64_t cost = frame_memory(work->planned.plan, stages_.outputs_of(*work));
            const std::uint64_t available = limit_ > base_ ? limit_ - base_ : 0;
            if (cost > available) {
                stages_.pool().clear();
                guard(*work, [&] { stages_.shade_in_bands(*work, limit_); });
                report(std::move(work));
            } else {
                run_pipeline(std::move(work), cost, available / std::max<std::uint64_t>(cost, 1));
            }
            measure_base();
        }
        if (fatal_) {
            std::rethrow_exception(fatal_);
        }
    }

  private:
    [[nodiscard]] bool stopped() const { return stop_ || listener_.interrupted(); }

    /// The next frame, planned; the one that was put back first. Null: none left.
    WorkPointer next() {
        if (stopped()) {
            return nullptr;
        }
        if (put_back_) {
            return std::move(put_back_);
        }
        if (position_ == jobs_.size()) {
            return nullptr;
        }
        auto work = std::make_unique<FrameWork>();
        work->job = &jobs_[position_++];
        guard(*work, [&] { stages_.plan(*work); });
        return work;
    }

    /// Runs a stage of a frame that is still under way; what it throws is the frame's failure.
    template <class Stage>
    void guard(FrameWork& work, const Stage& stage) {
        if (!work.open() || stopped()) {
            return;
        }
        try {
            stage();
        } catch (...) {
            work.failure = std::current_exception();
        }
    }

    /// Shades frames from `first` on, at most `room` at once, until there are no more or one comes that takes more
    /// memory than `cost`; that one is put back.
    void run_pipeline(WorkPointer first, std::uint64_t cost, std::uint64_t room) {
        const auto threads = static_cast<std::uint64_t>(settings_.threads);
        const auto most = settings_.threads == 1 ? 1 : threads + frames_waiting;
        const auto tokens = static_cast<std::size_t>(std::clamp<std::uint64_t>(room, 1, most));
        const bool only_one = !measured_ && settings_.max_memory > 0;
        const auto feed = [&](tbb::flow_control& control) -> FrameWork* {
            WorkPointer work = first ? std::move(first) : (only_one ? nullptr : next());
            if (work && work->open() && frame_memory(work->planned.plan, stages_.outputs_of(*work)) > cost) {
                put_back_ = std::move(work);
            }
            if (!work) {
                control.stop();
            }
            return work.release();
        };
        using tbb::filter_mode;
        const auto stage = [this](void (FrameStages::*function)(FrameWork&)) {
            return [this, function](FrameWork* work) {
                guard(*work, [&] { (stages_.*function)(*work); });
                return work;
            };
        };
        tbb::parallel_pipeline(
            tokens,
            tbb::make_filter<void, FrameWork*>(filter_mode::serial_in_order, feed) &
                tbb::make_filter<FrameWork*, FrameWork*>(filter_mode::parallel, stage(&FrameStages::read)) &
                tbb::make_filter<FrameWork*, FrameWork*>(filter_mode::serial_in_order, stage(&FrameStages::shade)) &
                tbb::make_filter<FrameWork*, FrameWork*>(filter_mode::parallel, stage(&FrameStages::write)) &
                tbb::make_filter<FrameWork*, void>(filter_mode::serial_in_order,
                                                   [this](FrameWork* work) { report(WorkPointer(work)); }));
    }

    void report(WorkPointer work) {
        stages_.release(*work);
        if (work->failure) {
            if (!stop_ && !listener_.failed(*work->job, work->failure)) {
                fatal_ = work->failure;
                stop_ = true;
            }
        } else if (work->done) {
            listener_.finished(*work->job, work->outcome);
        } // else: discarded by an interruption
    }

    /// With a limit: what the process holds beside frames, once the first one has brought everything in.
    void measure_base() {
        if (!measured_ && settings_.max_memory > 0) {
            stages_.pool().clear();
            base_ = resident_memory();
            measured_ = true;
        }
    }

    std::span<const FrameJob> jobs_;
    const BatchSettings& settings_;
    BatchListener& listener_;
    FrameStages stages_;
    std::uint64_t limit_;
    std::uint64_t base_;
    bool measured_ = false;
    std::size_t position_ = 0;
    WorkPointer put_back_;
    std::atomic<bool> stop_{false};
    std::exception_ptr fatal_;
};

} // namespace

void run_batch(std::span<const FrameJob> jobs, const RunScene& scene, const BatchSettings& settings,
               BatchResources& resources, BatchListener& listener) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, workers_for(settings));
    std::vector<std::filesystem::path> outputs;
    for (const FrameJob& job : jobs) {
        outputs.push_back(job.output);
        if (!job.preview.empty()) {
            outputs.push_back(job.preview);
        }
    }
    remove_stale_temporaries(outputs);
    tbb::task_arena arena(static_cast<int>(workers_for(settings)));
    arena.execute([&] { BatchRun(jobs, scene, settings, resources, listener).run(); });
}

} // namespace clshade

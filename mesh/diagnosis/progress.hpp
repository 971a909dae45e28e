// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>

namespace penumbra::mesh {

/// A range [begin, end] of the progress reported to a caller; values rise, and calls do not overlap.
class Progress {
 public:
  Progress(const std::function<void(double)>& report, double begin, double end)
      : report_(&report), begin_(begin), end_(end) {}

  /// Counts work that many threads do, and reports progress about two hundred times.
  class Counter {
   public:
    Counter(const Progress& progress, std::size_t count) : progress_(progress), count_(count) {}
    void done_one() {
      const std::size_t done = ++done_;
      if (*progress_.report_ == nullptr || done % (count_ / 200 + 1) != 0) return;
      const std::scoped_lock lock(mutex_);
      if (done <= reported_) return;
      reported_ = done;
      progress_.report_share(static_cast<double>(done) / static_cast<double>(count_));
    }

   private:
    const Progress& progress_;
    std::size_t count_, reported_ = 0;
    std::atomic<std::size_t> done_ = 0;
    std::mutex mutex_;
  };

 private:
  void report_share(double share) const { (*report_)(begin_ + share * (end_ - begin_)); }

  const std::function<void(double)>* report_;
  double begin_, end_;
};

}  // namespace penumbra::mesh

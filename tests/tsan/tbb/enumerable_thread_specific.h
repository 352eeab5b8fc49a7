// As threads.h says.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace tbb {

/// Threads of the stand-in end with their loop, and another may get the number of one that has ended: it then goes on with
/// what that one had, as it would with TBB.
template <class Value>
class enumerable_thread_specific {
 public:
  enumerable_thread_specific() : make_([] { return std::make_unique<Value>(); }) {}
  template <class Make>
  explicit enumerable_thread_specific(const Make& make)
      : make_([make] { return std::unique_ptr<Value>(new Value(make())); }) {}

  Value& local() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::unique_ptr<Value>& own = values_[std::this_thread::get_id()];
    if (!own) own = make_();
    return *own;
  }

  class const_iterator {
   public:
    using Place = typename std::map<std::thread::id, std::unique_ptr<Value>>::const_iterator;
    explicit const_iterator(Place at) : at_(at) {}
    const Value& operator*() const { return *at_->second; }
    const_iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator!=(const const_iterator& o) const { return at_ != o.at_; }

   private:
    Place at_;
  };
  const_iterator begin() const { return const_iterator(values_.begin()); }
  const_iterator end() const { return const_iterator(values_.end()); }

 private:
  std::function<std::unique_ptr<Value>()> make_;
  std::mutex mutex_;
  std::map<std::thread::id, std::unique_ptr<Value>> values_;
};

}  // namespace tbb

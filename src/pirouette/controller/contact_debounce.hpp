// Debounced contact flag of a foot.
#pragma once

namespace pirouette {

/// Contact flag that changes when the raw flag has differed from it for `ticks` updates in a row;
/// with 1 it equals the raw flag.
class ContactDebounce {
 public:
  explicit ContactDebounce(int ticks) : ticks_(ticks) {}  ///< `ticks` >= 1

  /// The flag after one more sample `raw`.
  bool update(bool raw) noexcept {
    changed_for_ = raw == flag_ ? 0 : changed_for_ + 1;
    if (changed_for_ >= ticks_) {
      changed_for_ = 0;
      flag_ = !flag_;
    }
    return flag_;
  }

  /// Sets the flag at once, without debouncing, and returns it.
  bool set(bool flag) noexcept { return flag_ = flag; }

  void reset() noexcept { *this = ContactDebounce(ticks_); }  ///< flag false

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [ticks, flag, changed_for] = self;
    visit(flag, changed_for);
  }

 private:
  int ticks_;
  bool flag_ = false;
  int changed_for_ = 0;  ///< updates that the raw flag has differed
};

}  // namespace pirouette

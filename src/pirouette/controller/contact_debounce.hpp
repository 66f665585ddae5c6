// A foot's contact flag without its chatter.
#pragma once

namespace pirouette {

/// The flag changes when the raw one has differed from it for `ticks` updates in a row; with 1 it
/// is the raw one.
class ContactDebounce {
 public:
  explicit ContactDebounce(int ticks) : ticks_(ticks) {}

  /// The flag after one more sample of the raw one.
  bool update(bool raw) noexcept {
    changed_for_ = raw == flag_ ? 0 : changed_for_ + 1;
    if (changed_for_ >= ticks_) {
      changed_for_ = 0;
      flag_ = !flag_;
    }
    return flag_;
  }

  /// Takes `flag` at once: it is no sample of a sensor.
  bool set(bool flag) noexcept { return flag_ = flag; }

  void reset() noexcept { *this = ContactDebounce(ticks_); }

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

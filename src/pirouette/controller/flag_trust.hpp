// Whether a foot's contact flag makes sense.
#pragma once

#include "pirouette/types/gait_phase.hpp"

namespace pirouette {

/// Compares the raw flag of one foot with what the foot is known to do: it is loaded while the
/// robot stands and in the middle of its scheduled stance, and in the air in the middle of its
/// swing. A flag that says otherwise for long (false while standing; false in the middle of stance
/// or true in the middle of swing, averaged over some strides) is not believed any more until
/// reset().
class FlagTrust {
 public:
  /// True while the flag is believed; `dt` in s.
  bool update(bool flag, const LegPhase& phase, bool walking, double dt) noexcept {
    if (!walking) {
      standing_.add(flag, dt);
      if (standing_.time > kStandingTime) {
        believed_ = believed_ && standing_.share() > kLeastShare;
        standing_ = {};
      }
      current_ = {};
      return believed_;
    }
    standing_ = {};
    if (phase.stance != in_stance_) {
      close();
      in_stance_ = phase.stance;
    }
    if (phase.progress > kMiddle && phase.progress < 1.0 - kMiddle) current_.add(flag, dt);
    return believed_;
  }

  bool believed() const noexcept { return believed_; }  ///< the flag is used

  void reset() noexcept { *this = FlagTrust(); }  ///< believes the flag again

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [believed, in_stance, standing, current, true_in_stance, true_in_swing] = self;
    visit(believed, in_stance, standing, current, true_in_stance, true_in_swing);
  }

 private:
  static constexpr double kStandingTime = 0.3;  // s, after which a flag at standing is judged
  static constexpr double kMiddle = 0.25;       // share of a stance or swing at each end left out
  static constexpr double kForgetting = 0.25;   // weight of the latest stance or swing
  static constexpr double kLeastShare = 0.5;    // of the time that a loaded foot's flag is true
  static constexpr double kMostShare = 0.8;     // of the time that a swinging foot's flag is true

  struct Seen {
    double time = 0.0;       ///< s
    double time_true = 0.0;  ///< s, of it with the flag true
    void add(bool flag, double dt) noexcept {
      time += dt;
      if (flag) time_true += dt;
    }
    double share() const noexcept { return time_true / time; }
  };

  /// The end of a stance or swing.
  void close() noexcept {
    if (current_.time > 0.0) {
      double& average = in_stance_ ? true_in_stance_ : true_in_swing_;
      average += kForgetting * (current_.share() - average);
      believed_ = believed_ && true_in_stance_ > kLeastShare && true_in_swing_ < kMostShare;
    }
    current_ = {};
  }

  bool believed_ = true;
  bool in_stance_ = true;
  Seen standing_, current_;
  double true_in_stance_ = 1.0, true_in_swing_ = 0.0;  ///< shares, averaged over the last strides
};

}  // namespace pirouette

#include "lipschitz.hpp"

#include <algorithm>

namespace maximin::checker {

LipschitzCheck::LipschitzCheck(ClaimCheck& claim, const Model& model, const Rational& l_r, const Rational& l_p,
                               const Rational& factor)
    : claim_(claim), m_(model), l_r_(l_r), l_p_(l_p), factor_(factor) {
  const Integer near = m_.metric.l2 ? Integer(1) << 64U : m_.metric.unit;
  const Integer of_p = lcm(Integer(l_p_.get_den() * near), m_.whole);
  right_bottom_ = lcm(lcm(Integer(l_r_.get_den() * near), m_.rewards.bottom), Integer(factor_.get_den() * of_p));
}

void LipschitzCheck::see(std::size_t n, const Table& x, const Rational& slack, bool proves) {
  if (claim_.wants_violations() && !proves) return;
  Waiting table{n, x, slack == 0 ? Integer(1) : Integer(slack.get_den() * m_.whole), {}, {}, {}, {}};
  table.of_row = slack.get_num() * x.bottom;
  table.bottom = x.bottom * table.of_x;
  const auto [least, most] = std::minmax_element(x.top.begin(), x.top.end());
  table.spread = Table{{*most - *least}, x.bottom}[0] + 2 * slack;
  waiting_bits_ += bits(x.size(), table.bottom);
  waiting_.push_back(std::move(table));
  if (waiting_bits_ > m_.most_bits) look();
}

void LipschitzCheck::look() {
  if (waiting_.empty()) return;
  if (least_) learn(*least_);
  m_.spend(claim_.path(), static_cast<double>(m_.states) * static_cast<double>(m_.states));
  std::vector<Integer> lengths(m_.states);
  for (std::size_t s = 0; s < m_.states; ++s) {
    m_.metric.from(s, lengths);
    for (std::size_t t = s + 1; t < m_.states; ++t) {
      if (lengths[t] >= 0 && !(farthest_ && lengths[t] > *farthest_)) look_at(s, t, lengths[t]);
    }
  }
  // The pair that the entry names may have been left out, as too far apart.
  const Place& at = claim_.place();
  const Integer length = at.s < at.t && at.t != Place::none ? m_.length(at.s, at.t) : Integer(-1);
  if (length >= 0) look_at(at.s, at.t, length);
  waiting_.clear();
  waiting_bits_ = 0;
}

/// What l_r d- and l_p d- make too small where d- is not the distance, the differences themselves make up for.
Rational LipschitzCheck::right(std::size_t s, std::size_t t, const Rational& near,
                               const std::vector<RowDifference>& rows) const {
  Table reward{{0}, m_.rewards.bottom}, move{{0}, m_.whole};
  for (std::size_t a = 0; a < m_.actions; ++a) {
    const Integer apart = abs(Integer(m_.rewards.top[m_.at(s, a)] - m_.rewards.top[m_.at(t, a)]));
    reward.top[0] = std::max(reward.top[0], apart);
    move.top[0] = std::max(move.top[0], rows[a].most);
  }
  return std::max(Rational(l_r_ * near), reward[0]) + factor_ * std::max(Rational(l_p_ * near), move[0]);
}

/// False where it is no instance that counts.
bool LipschitzCheck::find_left(const Waiting& table, std::size_t s, std::size_t t, std::size_t a,
                               const RowDifference& row, Integer& left) const {
  left = table.x.top[m_.at(s, a)] - table.x.top[m_.at(t, a)];
  left = abs(left);
  left *= table.of_x;
  if (table.of_row == 0) return true;
  if (row.sum != 0 && claim_.wants_violations()) return false;
  left += table.of_row * row.sum;
  return true;
}

void LipschitzCheck::look_at(std::size_t s, std::size_t t, const Integer& length) {
  m_.spend(claim_.path(), static_cast<double>(m_.actions * (waiting_.size() + 4)));
  std::vector<RowDifference> rows;
  for (std::size_t a = 0; a < m_.actions; ++a) rows.push_back(row_difference(m_, s, t, a));
  const Rational right_side = right(s, t, m_.metric.near(length), rows);
  const Integer right_top = right_side.get_num() * (right_bottom_ / right_side.get_den());
  const bool named = claim_.place().s == s && claim_.place().t == t;
  Integer left, gap;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const Waiting& table = waiting_[i];
    const Integer right_here = right_top * table.bottom;
    for (std::size_t a = 0; a < m_.actions; ++a) {
      if (!find_left(table, s, t, a, rows[a], left)) continue;
      gap = right_here - left * right_bottom_;
      const bool news = !least_ || gap < table.below;
      if (!news && !(named && claim_.place().n == table.n && claim_.place().a == a)) continue;
      const Rational left_side = Table{{left}, table.bottom}[0];
      claim_.see({table.n, s, t, a}, left_side, right_side);
      if (news) learn(right_side - left_side);
    }
  }
}

/// right(s,t) is (l_r + factor l_p) d- or more: far enough apart, no two states can be tighter.
void LipschitzCheck::learn(const Rational& least) {
  least_ = least;
  Rational spread;
  for (Waiting& table : waiting_) {
    const Rational scaled = least * table.bottom * right_bottom_;
    mpz_cdiv_q(table.below.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
    spread = std::max(spread, table.spread);
  }
  const Rational slope = l_r_ + factor_ * l_p_;
  if (slope == 0) return;
  const Rational enough = std::max(Rational(0), Rational((least + spread) / slope));
  farthest_ = m_.metric.reach(m_.metric.l2 ? Rational(enough + Rational(1, Integer(1) << 64U)) : enough);
}

}  // namespace maximin::checker

#include <cstdio>

long period_of_the_cycle();

int main() {
  const long period = period_of_the_cycle();
  std::printf("period %ld\n", period);
  return period == 3 ? 0 : 1;
}

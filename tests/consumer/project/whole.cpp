#include <cstdio>

long period_of_the_cycle();
bool upper_floors_work();

int main() {
  const long period = period_of_the_cycle();
  std::printf("period %ld\n", period);
#ifdef EVERY_FLOOR
  if (!upper_floors_work()) return 2;
#endif
  return period == 3 ? 0 : 1;
}

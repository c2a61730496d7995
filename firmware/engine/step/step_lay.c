#include "step_lay.h"

void step_lay_search(struct step_generator *generator, struct step_guess guess)
{
    uint64_t gain = wide_from_signed((int64_t)generator->accel * (int32_t)guess.interval);
    generator->residual = (guess.residual + STEP_QUANTA) - (guess.interval * (guess.slope - gain));
    generator->slope = guess.slope - (2U * gain);
    (void)step_generator_search(generator, guess.interval);
}

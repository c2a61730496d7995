"""Errors that the proofs must find: contracts, function, source, what is right, what is wrong."""

from __future__ import annotations

PLANTED = [
    (
        "base_tick", "tick_is_before", "firmware/base/base_tick.c",
        "tick_difference(a, b) < 0", "tick_difference(a, b) <= 0",
    ),
    (
        "base_wide_digit", "divide_digit", "firmware/base/base_wide.c",
        "left += high;", "left += high - 1U;",
    ),
    (
        "base_wide_divide", "leading_zeros", "firmware/base/base_wide.c",
        "HALF_BITS : WORD_BITS) - bits", "HALF_BITS : WORD_BITS) - bits + 1U",
    ),
    (
        "path_wide", "path_wide_multiply", "firmware/engine/path/path_wide.h",
        "(uint32_t)middle", "middle",
    ),
    (
        "path_digit", "path_digit", "firmware/engine/path/path_digit.h",
        "left >= divisor && left < way", "left < way",
    ),
    (
        "path_divide_reciprocal", "reciprocal_of", "firmware/engine/path/path_divide.c",
        "if (rest >= high)", "if (rest > high)",
    ),
    (
        "path_divide_digit", "digit_of", "firmware/engine/path/path_divide.c",
        "if (left >= scaled)", "if (left > scaled)",
    ),
    (
        "path_divide", "pushed_out", "firmware/engine/path/path_divide.c",
        "WORD_BITS - 1U - shift", "WORD_BITS - shift",
    ),
    (
        "path_divide_wide", "path_divide_wide", "firmware/engine/path/path_divide.c",
        "left = pushed_out(dividend.high, shift)", "left = pushed_out(dividend.low, shift)",
    ),
    (
        "path_fixed", "path_fixed_multiply", "firmware/engine/path/path_fixed.c",
        "whole.low > PATH_FIXED_NEVER", "false",
    ),
    (
        "path_fixed_slope", "path_fixed_slope", "firmware/engine/path/path_fixed.c",
        "(ROOT_BITS - bits) / 2U", "(ROOT_BITS + 2U - bits) / 2U",
    ),
    (
        "path_root", "root_of_two_words", "firmware/engine/path/path_root.c",
        "if (rest < way)", "if (rest <= way)",
    ),
    (
        "path_root_wide", "root_of_four_words", "firmware/engine/path/path_root.c",
        "if (left >= high.root)", "if (left > high.root)",
    ),
    (
        "path_root_nearest", "path_root", "firmware/engine/path/path_root.c",
        "rest > root ? root + 1U : root", "rest >= root ? root + 1U : root",
    ),
    (
        "path_segment_pieces", "ticks_of", "firmware/engine/path/path_segment.c",
        "slope / 16U : slope / 4U", "slope / 8U : slope / 4U",
    ),
    (
        "path_segment_pulses", "pulses_of", "firmware/engine/path/path_segment.c",
        "1U + (uint32_t)lower(left, steps)", "2U + (uint32_t)lower(left, steps)",
    ),
    (
        "path_segment_slope", "slope_at", "firmware/engine/path/path_segment.c",
        "divisor.shift -= 8U", "divisor.shift -= 7U",
    ),
    (
        "path_segment_lay", "path_segment_lay", "firmware/engine/path/path_segment.c",
        "slope >= SLOPE_LEAST && (", "(",
    ),
    (
        "path_vector", "divide", "firmware/engine/path/path_vector.c",
        "dividend.high >= divisor", "dividend.high > divisor",
    ),
    (
        "path_fixed_pace", "path_fixed_pace", "firmware/engine/path/path_fixed.c",
        "WORD_BITS - 1U - path_wide_bits(slope.high)", "WORD_BITS - path_wide_bits(slope.high)",
    ),
    (
        "path_course", "profile_of", "firmware/engine/path/path_course.c",
        "profile.turn = lower(limit, meet)", "profile.turn = limit",
    ),
    (
        "path_course_speeds", "speed_of", "firmware/engine/path/path_course.c",
        "speeds->last ^= 1U", "speeds->last += 1U",
    ),
    (
        "path_course_cruise", "steps_of", "firmware/engine/path/path_course.c",
        ".high = course->length", ".high = course->length + 1U",
    ),
    (
        "path_course_ramp", "ramp_time", "firmware/engine/path/path_course.c",
        "path_wide_is_at_least(slope_a, slope_b)", "path_wide_is_at_least(slope_b, slope_a)",
    ),
    (
        "path_course_pulse", "path_course_last_pulse", "firmware/engine/path/path_course.c",
        "return steps", "return steps + 1U",
    ),
    (
        "path_course_place", "slope256_of", "firmware/engine/path/path_course.c",
        "slope.high << 8U", "slope.high << 9U",
    ),
    (
        "path_course_root", "root256", "firmware/engine/path/path_course.c",
        "twice_speed2.high), 16U)", "twice_speed2.high), 18U)",
    ),
    (
        "path_course_square", "twice_speed2_at", "firmware/engine/path/path_course.c",
        "path_wide_subtract(begin, change)", "path_wide_add(begin, change)",
    ),
    (
        "path_course_ramp_pulse", "ramp_pulse", "firmware/engine/path/path_course.c",
        "{.high = change >> 8U,", "{.high = change,",
    ),
    (
        "path_course_at", "path_course_at", "firmware/engine/path/path_course.c",
        "leg->twice_speed2 - way", "leg->twice_speed2 + way",
    ),
    (
        "path_course_leg", "set_speed", "firmware/engine/path/path_course.c",
        "speed_of(at->speeds, twice_speed2)", "speed_of(at->speeds, 0)",
    ),
    (
        "path_course_lay_cruise", "lay_cruise", "firmware/engine/path/path_course.c",
        "leg->end = end", "leg->end = at->place",
    ),
    (
        "path_course_lay_ramp", "lay_ramp", "firmware/engine/path/path_course.c",
        "at->place = leg->end", "at->place = leg->place",
    ),
    (
        "path_course_step", "path_course_step", "firmware/engine/path/path_course.c",
        "leg = &course->leg[i + 1U]", "leg = &course->leg[i + 2U]",
    ),
    (
        "path_lay", "pulses_at", "firmware/engine/path/path_lay.c",
        "uint64_t way = step * steps", "uint64_t way = step * steps + length",
    ),
    (
        "path_lay_anew", "path_lay_anew", "firmware/engine/path/path_lay.c",
        "path->stopping ? 0 : section->vector.speed", "section->vector.speed",
    ),
    (
        "path_lay_begin", "path_lay_begin", "firmware/engine/path/path_lay.c",
        "cursor->pulse = pulses[axis] + 1U", "cursor->pulse = pulses[axis]",
    ),
    (
        "path_lay_begin", "path_lay_begin", "firmware/engine/path/path_lay.c",
        "path->kept[i].valid = false", "path->kept[i].valid = true",
    ),
    (
        "path_lay_leave", "come_to_rest", "firmware/engine/path/path_lay.c",
        ".place = inside ? course->end : (struct wide){0}", ".place = course->end",
    ),
    (
        "path_add", "path_add", "firmware/engine/path/path.c",
        "if (path->end - path->first == path->size)", "if (vector->straight)",
    ),
    (
        "path_cursor", "seek_leg", "firmware/engine/path/path.c",
        "cursor->pulse <= cursor->last", "cursor->pulse <= cursor->last + 1U",
    ),
    (
        "path_reach", "reach", "firmware/engine/path/path.c",
        "path_is_laid(path) || path->next.time.high", "path->next.time.high",
    ),
    (
        "path_late", "cursor_is_late", "firmware/engine/path/path.c",
        "tick >= until_tick", "tick > until_tick",
    ),
    (
        "path_lags", "path_lags", "firmware/engine/path/path.c",
        "if (path_is_laid(path))", "if (path->stopping)",
    ),
    (
        "path_drop", "path_drop", "firmware/engine/path/path.c",
        "axis < (unsigned)PATH_AXES", "axis <= (unsigned)PATH_AXES",
    ),
    (
        "path_look", "path_look_exit2", "firmware/engine/path/path_look.c",
        "most < least ? least : most", "most",
    ),
    (
        "path_look_backward", "look_backward", "firmware/engine/path/path_look.c",
        "lower(cap2, exit2 + after->gain2)", "cap2",
    ),
    (
        "path_look_again", "look_backward_again", "firmware/engine/path/path_look.c",
        "if (before->exit2 == exit2)", "if (before->exit2 <= exit2)",
    ),
    (
        "path_look_entry", "path_look", "firmware/engine/path/path_look.c",
        "path->looked = path->known", "path->looked = path->end",
    ),
    (
        "path_look_due", "path_look_again", "firmware/engine/path/path_look.c",
        "uint32_t last = path->looked - 1U", "uint32_t last = path->looked",
    ),
    (
        "path_look_more", "path_look_is_more", "firmware/engine/path/path_look.c",
        "path->looked != path->known", "path->looked != path->end",
    ),
    (
        "path_change_way", "way_at", "firmware/engine/path/path_change.c",
        "ticks = ticks < until_stand ? ticks : until_stand", "ticks = ticks + until_stand",
    ),
    (
        "path_change_counts", "count_void", "firmware/engine/path/path_change.c",
        "return count - there", "return count",
    ),
    (
        "path_change_counts", "is_handed_over", "firmware/engine/path/path_change.c",
        "made < path_section_steps", "made <= path_section_steps",
    ),
    (
        "path_change_section", "section_at", "firmware/engine/path/path_change.c",
        "path->laid == path->origin.section || ", "",
    ),
    (
        "path_change_early", "find_early", "firmware/engine/path/path_change.c",
        "early.time.high >= look->early_tick && ", "",
    ),
    (
        "path_change_border", "pass_border", "firmware/engine/path/path_change.c",
        "place->entry.place = (struct wide){0}", "place->entry.place = (struct wide){1}",
    ),
    (
        "path_change_before", "keep_before", "firmware/engine/path/path_change.c",
        "kept->valid && kept->section == place->section", "kept->valid",
    ),
    (
        "path_change_origin", "find_origin", "firmware/engine/path/path_change.c",
        "wish->accel != 0 && rest != 0", "rest != 0",
    ),
    (
        "path_change_back", "path_back", "firmware/engine/path/path_change.c",
        "!is_handed_over(path, place, axis, there[axis])", "false",
    ),
    (
        "path_change_rests", "path_can_rest", "firmware/engine/path/path_change.c",
        "steps - (rest != 0 ? 1U : 0U)", "steps",
    ),
    (
        "path_change_steps", "find_step", "firmware/engine/path/path_change.c",
        "near > before ? near : before + 1U", "near",
    ),
    (
        "path_change_betweens", "between_steps", "firmware/engine/path/path_change.c",
        "place.low % 2U", "place.low % 3U",
    ),
    (
        "path_change_betweens", "find_between", "firmware/engine/path/path_change.c",
        "look.leg->time.high + 1U", "look.tick",
    ),
    (
        "path_change_finds", "find_in", "firmware/engine/path/path_change.c",
        "entry->place = path_wide_multiply(grains_per_step, step)",
        "entry->place = path_wide_multiply(grains_per_step, step + 1U)",
    ),
    (
        "path_change_kept", "find_before", "firmware/engine/path/path_change.c",
        "path_lay_grains(path, place)", "0",
    ),
    (
        "path_vector_take", "path_section_take", "firmware/engine/path/path_vector.c",
        "vector->extent2 == square", "vector->extent2 >= square",
    ),
    (
        "path_vector_turns", "path_section_mind_turns", "firmware/engine/path/path_vector.c",
        "steps < section->turning ? steps", "steps < section->turning ? turn_us",
    ),
    (
        "motion_time", "motion_time_add", "firmware/engine/motion/motion_time.c",
        "time.ticks + ticks + (fraction", "time.ticks + ticks + 1U + (fraction",
    ),
    (
        "motion_lookahead", "border_cap", "firmware/engine/motion/motion_lookahead.c",
        "section + 1U < order->sections", "section + 1U <= order->sections",
    ),
    (
        "motion_lookahead_forward", "motion_lookahead_forward",
        "firmware/engine/motion/motion_lookahead.c",
        "motion_lower(plan->exit_speed2[i], enter + gain)", "plan->exit_speed2[i]",
    ),
    (
        "link_receiver", "take_plain", "firmware/rkm04/link/link_receiver.c",
        "if (place == (uint32_t)", "if (place > (uint32_t)",
    ),
    (
        "program_memory", "program_memory_find_label", "firmware/rkm04/program/program_memory.c",
        "if (next == 0 || ", "if (",
    ),
    (
        "interpreter_stacks", "run_call", "firmware/rkm04/interpreter/interpreter_commands.c",
        "call_depth == INTERPRETER_CALLS_MAX", "call_depth > INTERPRETER_CALLS_MAX",
    ),
    (
        "link_sender", "plain_byte", "firmware/rkm04/link/link_sender.c",
        "sender->message[place - PLACE_MESSAGE]", "sender->message[place - PLACE_NUMBER]",
    ),
    (
        "step_channel", "cursor_begin_segment", "firmware/engine/step/step_channel.c",
        "cursor->left = segment->steps - 1U", "cursor->left = segment->steps",
    ),
    (
        "step_generator", "search_shorten", "firmware/engine/step/step_generator.c",
        "search->interval -= ticks;", "search->interval -= ticks + 1U;",
    ),
    (
        "step_generator", "step_generator_guess", "firmware/engine/step/step_generator.h",
        ".slope = middle + gain", ".slope = middle",
    ),
    (
        "step_lay", "step_lay_is_surely_near", "firmware/engine/step/step_lay.h",
        "way < speed - 1U", "way < speed",
    ),
    (
        "step_lay", "step_lay_cruise", "firmware/engine/step/step_lay.h",
        "way += slope;", "way += slope + rest;",
    ),
]  # fmt: skip

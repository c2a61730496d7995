/*
 * The recall of a path (firmware/engine/group/group_change.c) on the step channels of its axes
 * (firmware/engine/step/step_channel.c and step_channel_change.c) and the backend that makes their pulses, for Spin.
 *
 * The planner hands segments of the path over, for each axis by itself. It changes the path from a place: the channels
 * take back what is laid after it and freeze, the path is planned, other segments come instead, and all go on at once. A
 * place is a pulse of each axis, any that has been handed over: the motors may have gone past it, and then what was
 * frozen goes on. The tick interrupt stops the group at any time that no hold is in force, main stops
 * it too, takes a stop back and, where it aborts all, halts the channels. The backend asks for pulses when no hold is in
 * force, and the hardware makes them at any time at all; what is taken back may be refused in part or as a whole. Spin
 * tries all orders. Main and the plan interrupt, which hold each other off, are one planner. The counters wrap after
 * COUNTS.
 *
 * A pulse is named by its segment and its place there, as in ring.pml, and `intended` has the names of each axis in the
 * order in which they must be made. A cursor has the name of the pulse that its generator stands on. Left out are ticks
 * and turns.
 *
 * PLANT_...: an error, to see that it is found.
 */
#ifndef AXES
#define AXES 1
#endif
#define SEGMENTS 2 /* places in a ring; 32 in the firmware */
#define COUNTS 4   /* 2^32 in the firmware */
#define AHEAD 2    /* pulses that are laid ahead at most */
#define STEPS 2    /* pulses of a segment at most */
#ifndef PUSHES
#define PUSHES 3 /* segments of an axis, all in all */
#endif
#define PULSES (PUSHES * STEPS)
#ifndef FIRST
#define FIRST 2 /* of them, before the first change */
#endif
#ifndef CHANGES
#define CHANGES 1 /* that are tried; those for a stop are tried again */
#endif
#ifndef STOPS
#define STOPS 1
#endif
#ifndef RESUMES
#define RESUMES 0
#endif
#ifndef ABORTS
#define ABORTS 0
#endif
#define NEXT(count) ((count + 1) % COUNTS)
#define BEFORE(count) ((count + COUNTS - 1) % COUNTS)
#define DISTANCE(head, tail) ((head + COUNTS - tail) % COUNTS)
#define NAME(segment, place) (segment * 4 + place)
#define CH channel[a]
/* Which of `cursor` is that of axis `a`, and which are the places that it keeps. */
#define CURSOR (a * 3)
#define KEPT (a * 3 + 1)
#define YOUNG (a * 3 + 1 + CH.young)
#define OLD (a * 3 + 2 - CH.young)

typedef slot {
    byte segment;
    byte steps
};

/* The end of its segment is pulse + left. Segment and place are those of the pulse that the generator stands on. */
typedef step_cursor {
    byte segment;
    byte place;
    byte left;
    byte tail;
    byte pulse
};

typedef step_channel {
    slot queue[SEGMENTS];
    byte young, head, taken;
    bool running, closed, frozen;
    byte recalled, until, pushed
};

/* The backend and the hardware of a motor. */
typedef output {
    byte waiting, made; /* pulses laid that have not been made, and pulses that have */
    bool asking, no_more /* the backend: asks for pulses; the channel had none left */
};

/* The path of an axis. */
typedef course {
    byte name;    /* of the segment handed over last */
    byte left;    /* segments that are yet to be handed over */
    byte planned; /* pulses that have been */
    byte place;   /* of a change */
    byte intended[PULSES + 1]
};

step_channel channel[AXES];
step_cursor cursor[AXES * 3];
output out[AXES];
course path[AXES];
bool held, thawing;
bool planned_anew; /* there is a place, and nothing after it may be made yet */

mtype = {MOVING, BRAKING, STOPPING, ENDED}; /* the states of the group */
mtype = {NO_CAUSE, PAUSE, FAULT};
mtype = {CHANGED, RESTS, LATER};
mtype state = MOVING, cause = NO_CAUSE;
mtype accepted = NO_CAUSE; /* what has been told to be the cause */
mtype braked = NO_CAUSE;   /* what the path has been stopped for */
byte stops = STOPS;

byte laid, room, back, cut, much, i, a, m; /* of one step, or in a hold */

inline copy(to, from)
{
    cursor[to].segment = cursor[from].segment;
    cursor[to].place = cursor[from].place;
    cursor[to].left = cursor[from].left;
    cursor[to].tail = cursor[from].tail;
    cursor[to].pulse = cursor[from].pulse
}

inline advance(c)
{
    if
    :: cursor[c].left > 0 ->
        cursor[c].left--;
        cursor[c].place++
    :: else ->
        cursor[c].segment = CH.queue[cursor[c].tail % SEGMENTS].segment;
        cursor[c].left = CH.queue[cursor[c].tail % SEGMENTS].steps - 1;
        cursor[c].place = 1;
        cursor[c].tail = NEXT(cursor[c].tail)
    fi;
    cursor[c].pulse++
}

/* step_channel_follow */
inline follow(c, to)
{
    do
    :: cursor[c].pulse < to && (cursor[c].left > 0 || cursor[c].tail != CH.head) -> advance(c)
    :: else -> break
    od
}

inline keep_nothing()
{
    copy(KEPT, CURSOR);
    copy(KEPT + 1, CURSOR);
    CH.taken = cursor[CURSOR].tail
}

/* Its name is that of its pulse. */
#define STANDS(c) (path[a].intended[cursor[c].pulse] == NAME(cursor[c].segment, cursor[c].place))

/* step_channel_lay_isr, from the backend's look at what waits to its care for what has been laid. */
inline lay_isr()
{
    laid = 0;
    room = AHEAD - out[a].waiting;
    if
#ifdef PLANT_NOTHING_LAID_WHILE_FROZEN
    :: CH.frozen -> room = 0
#else
#ifdef PLANT_PLACE_LAID_OVER
    :: false ->
#else
    :: CH.frozen ->
#endif
        if
        :: cursor[CURSOR].pulse + room <= CH.until
        :: cursor[CURSOR].pulse <= CH.until && cursor[CURSOR].pulse + room > CH.until -> room = CH.until - cursor[CURSOR].pulse
        :: cursor[CURSOR].pulse > CH.until -> room = 0
        fi
#endif
    :: else
    fi;
    if
    :: room == 0 ->
#ifdef PLANT_REST_WHILE_FROZEN
        CH.running = out[a].waiting > 0;
#endif
        no_more_pulses()
    :: else ->
        if
        :: cursor[YOUNG].pulse <= cursor[CURSOR].pulse - out[a].waiting ->
            CH.taken = cursor[YOUNG].tail;
            CH.young = 1 - CH.young;
            copy(YOUNG, CURSOR)
        :: else
        fi;
        do
        :: laid < room && (cursor[CURSOR].left > 0 || cursor[CURSOR].tail != CH.head) ->
            advance(CURSOR);
            laid++;
            assert(cursor[CURSOR].pulse <= path[a].planned && STANDS(CURSOR));
            assert(!planned_anew || thawing || cursor[CURSOR].pulse <= path[a].place)
        :: laid > 0 || (cursor[CURSOR].left == 0 && cursor[CURSOR].tail == CH.head) -> break
        od;
        if
        :: laid == 0 && out[a].waiting == 0 ->
            keep_nothing();
            CH.running = false;
            out[a].asking = false
        :: laid == 0 && out[a].waiting > 0 -> out[a].no_more = true
        :: laid > 0 -> out[a].no_more = false
        fi
    fi;
    out[a].waiting = out[a].waiting + laid;
    laid = 0;
    room = 0
}

/* The backend asks once more when all has been made, and not again before it is told to run. */
inline no_more_pulses()
{
    out[a].no_more = true;
    out[a].asking = out[a].waiting > 0
}

inline hold()
{
    atomic { !held -> held = true }
}

inline check(k)
{
    assert(cursor[k * 3].pulse - channel[k].recalled - out[k].waiting == out[k].made);
    assert(channel[k].running || (out[k].waiting == 0 && cursor[k * 3].left == 0))
}

inline release()
{
    atomic {
        check(0);
#if AXES > 1
        check(1);
#endif
        held = false;
        thawing = false;
        back = 0;
        cut = 0;
        much = 0;
        i = 0
    }
}

/* The seam. */
inline hal_step_run()
{
    atomic {
        out[a].asking = true;
        out[a].no_more = false;
        if
        :: out[a].waiting < AHEAD -> lay_isr()
        :: out[a].waiting > 0
        fi
    }
}

/* What has been taken back may leave the backend without a wish for more. */
inline hal_step_take_back(count)
{
    back = 0;
    do
    :: back < count && back < out[a].waiting -> back++
    :: break
    od;
    out[a].waiting = out[a].waiting - back;
    if
    :: back > 0 -> out[a].asking = false
    :: true
    fi
}

proctype hardware(byte k)
{
end:
    do
    :: atomic { out[k].waiting > 0 -> out[k].waiting--; out[k].made++ }
    od
}

proctype interrupt(byte k)
{
end:
    do
    :: atomic {
        out[k].asking && !held && out[k].waiting < AHEAD && (!out[k].no_more || out[k].waiting == 0) ->
        m = a;
        a = k;
        lay_isr();
        a = m;
        m = 0
       }
    od
}

inline end_with(c, to)
{
    if
    :: cursor[c].tail == cursor[CURSOR].tail && to < cursor[c].pulse + cursor[c].left ->
        assert(cursor[c].pulse <= to);
        cursor[c].left = to - cursor[c].pulse
    :: else
    fi
}

/* channel_truncate */
inline truncate(last)
{
    if
    :: cursor[CURSOR].tail != CH.taken && last < cursor[CURSOR].pulse + cursor[CURSOR].left ->
        cut = cursor[CURSOR].pulse + cursor[CURSOR].left - last;
        assert(CH.queue[BEFORE(cursor[CURSOR].tail) % SEGMENTS].steps > cut);
        CH.queue[BEFORE(cursor[CURSOR].tail) % SEGMENTS].steps = CH.queue[BEFORE(cursor[CURSOR].tail) % SEGMENTS].steps - cut
    :: else
    fi;
    end_with(KEPT, last);
    end_with(KEPT + 1, last);
    end_with(CURSOR, last);
    cut = last - cursor[CURSOR].pulse - cursor[CURSOR].left; /* pulses to be kept in the queue */
#ifndef PLANT_QUEUE_KEPT
    CH.head = cursor[CURSOR].tail;
    do
    :: cut > 0 ->
        if
        :: cut < CH.queue[CH.head % SEGMENTS].steps -> CH.queue[CH.head % SEGMENTS].steps = cut
        :: else
        fi;
        cut = cut - CH.queue[CH.head % SEGMENTS].steps;
        CH.head = NEXT(CH.head)
    :: else -> break
    od;
#endif
#ifndef PLANT_COUNT_KEPT
    CH.pushed = last;
#endif
    cut = 0
}

/* channel_end_at */
inline end_at(last)
{
    cursor[CURSOR].pulse = last;
    cursor[CURSOR].left = 0;
    CH.pushed = last;
    CH.head = cursor[CURSOR].tail;
    keep_nothing()
}

/* step_channel_base */
inline base(c, upto)
{
    if
    :: cursor[YOUNG].pulse <= upto -> copy(c, YOUNG)
    :: else -> copy(c, OLD)
    fi
}

/* channel_go_back */
inline go_back()
{
    if
    :: CH.recalled > 0 ->
        laid = cursor[CURSOR].pulse - CH.recalled;
#ifndef PLANT_CURSOR_LEFT
        base(CURSOR, laid);
        follow(CURSOR, laid);
        assert(cursor[CURSOR].pulse == laid && STANDS(CURSOR));
#endif
#ifndef PLANT_WAY_BACK_OVER_PLACE
        copy(YOUNG, CURSOR);
#endif
        laid = 0
    :: else
    fi;
#ifndef PLANT_RECALLED_KEPT
    CH.recalled = 0;
#endif
    skip
}

/* step_channel_thaw_held */
inline thaw_held()
{
    atomic {
        go_back();
        CH.frozen = false
    };
    if
#ifdef PLANT_NOT_RUN
    :: false
#else
    :: CH.running -> hal_step_run()
#endif
    :: else
    fi
}

/* channel_has_room_after; `cut` pulses are left on the way there. */
inline find_room(upto)
{
    i = DISTANCE(cursor[CURSOR].tail, CH.taken);
    cut = (upto > cursor[CURSOR].pulse + cursor[CURSOR].left -> upto - cursor[CURSOR].pulse - cursor[CURSOR].left : 0);
    m = cursor[CURSOR].tail;
    do
    :: cut > 0 ->
        cut = (cut > CH.queue[m % SEGMENTS].steps -> cut - CH.queue[m % SEGMENTS].steps : 0);
        m = NEXT(m);
        i++
    :: else -> break
    od;
    m = 0
}

/* step_channel_freeze of axis `a`, `in_time` goes out. */
inline freeze()
{
    atomic {
        hold();
        laid = CH.pushed - (path[a].planned - path[a].place);
        much = (laid < cursor[CURSOR].pulse -> cursor[CURSOR].pulse - laid : 0);
        find_room(laid);
#ifdef PLANT_ROOM_NOT_LOOKED_AT
        in_time = true;
#else
        in_time = i < SEGMENTS;
#endif
        if
        :: much > 0 ->
            hal_step_take_back(much);
            CH.recalled = back
        :: else
        fi;
        CH.until = laid;
        CH.frozen = true;
#ifdef PLANT_FROZEN_IN_PART
        in_time = in_time && (CH.recalled > 0 || much == 0);
#else
        in_time = in_time && CH.recalled == much;
#endif
        laid = 0;
        if
        :: in_time -> release()
        :: else
        fi
    };
    if
    :: !in_time ->
        atomic {
            thaw_held();
            release()
        }
    :: else
    fi
}

/* thaw, of the motors before `count` */
inline thaw(count)
{
    atomic {
        hold();
        thawing = planned_anew;
        a = count;
        do
        :: a > 0 -> a--; thaw_held()
#ifdef PLANT_THAWED_APART
            ; release(); hold()
#endif
        :: else -> break
        od;
        planned_anew = false;
        release()
    }
}

/* path_next: what it tells is to be made. */
inline path_next()
{
    path[a].left--;
    path[a].name++;
    if
    :: steps = 1
    :: steps = 2
    fi;
    i = 0;
    do
    :: i < steps ->
        i++;
        path[a].planned++;
        path[a].intended[path[a].planned] = NAME(path[a].name, i)
    :: else -> break
    od;
    i = 0
}

/* step_channel_append */
inline append()
{
    CH.queue[CH.head % SEGMENTS].segment = path[a].name;
    CH.queue[CH.head % SEGMENTS].steps = steps;
    CH.pushed = CH.pushed + steps;
    CH.head = NEXT(CH.head)
}

#define HAS_ROOM(k) (DISTANCE(channel[k].head, channel[k].taken) < SEGMENTS)

/* group_feed_axis: step_channel_push, and step_channel_run where the motor rests */
inline feed(k)
{
    atomic {
        a = k;
        path_next();
        hold();
        assert(!CH.closed);
        in_time = !CH.running || (cursor[CURSOR].left == 0 && cursor[CURSOR].tail == CH.head);
        append();
        steps = 0;
        CH.running = true;
        if
        :: in_time -> hal_step_run()
        :: else
        fi;
        in_time = false;
        release();
        a = 0
    }
}

/* step_channel_recall of axis `a` */
inline recall()
{
    atomic {
        hold();
        go_back();
        laid = CH.pushed - much;
        truncate(laid);
        laid = 0;
        if
        :: steps > 0 ->
            append();
#ifndef PLANT_REST_NOT_LEFT
            CH.running = true;
#endif
            skip
        :: else
        fi;
        release()
    }
}

/* All that comes after the place is planned anew: what there was is not to be made. */
inline plan_anew()
{
    assert(out[a].made <= path[a].place && cursor[CURSOR].pulse - CH.recalled <= path[a].place);
    much = path[a].planned - path[a].place;
    backs[a] = much;
    i = path[a].place;
    do
    :: i < path[a].planned -> i++; path[a].intended[i] = 0
    :: else -> break
    od;
    path[a].planned = path[a].place;
    path[a].left = PUSHES - path[a].name;
    do
    :: path[a].left > 0 -> path[a].left--
    :: break
    od;
    i = 0
}

#if AXES > 1
#define ALL(what0, what1) ((what0) && (what1))
#else
#define ALL(what0, what1) (what0)
#endif
#define IS_MADE(k) (out[k].made == path[k].place)

/* plan_from */
inline plan_from()
{
    atomic {
        if
        :: state == BRAKING -> braked = (hard -> FAULT : PAUSE)
        :: else -> braked = NO_CAUSE
        fi;
        planned_anew = true;
        a = 0;
        do
        :: a < AXES -> plan_anew(); a++
        :: else -> break
        od;
        a = 0
    };
#ifdef PLANT_HALTED_WHILE_FROZEN
    halt();
#endif
    do
    :: a < AXES ->
        atomic {
            if
            :: path[a].left > 0 -> path_next()
            :: true
            fi;
            much = backs[a];
            recall();
            backs[a] = 0;
            steps = 0;
            a++
        }
    :: else -> break
    od;
    a = 0;
    do
    :: path[0].left > 0 && HAS_ROOM(0) -> feed(0)
#if AXES > 1
    :: path[1].left > 0 && HAS_ROOM(1) -> feed(1)
#endif
    :: break
    od;
    if
    :: true -> ALL(IS_MADE(0), IS_MADE(1)) /* it is late */
    :: true
    fi;
    thaw(AXES)
}

inline choose_place(k)
{
    select(place: 0 .. path[k].planned);
    path[k].place = place;
    place = 0
}

/* change; `result` goes out. */
inline change()
{
    atomic {
        hard = state == BRAKING && cause == FAULT;
        if
        :: result = LATER
        :: ALL(path[0].left == 0, path[1].left == 0) -> result = RESTS
        :: result = CHANGED;
            choose_place(0);
#if AXES > 1
            choose_place(1);
#endif
        fi
    };
    if
    :: result == CHANGED ->
        a = 0;
        do
        :: a < AXES ->
            freeze();
            if
            :: in_time -> a++
            :: else ->
#ifdef PLANT_ONE_LEFT_OUT
                a++
#else
#ifndef PLANT_OTHERS_STAY_FROZEN
                thaw(a);
#endif
                result = LATER;
                break
#endif
            fi
        :: else -> break
        od;
        in_time = false;
        a = 0;
        if
        :: result == CHANGED -> plan_from()
        :: else
        fi
    :: else
    fi;
    atomic {
        a = 0;
        hard = false;
        path[0].place = 0;
#if AXES > 1
        path[1].place = 0
#endif
    }
}

/* group_stop_isr; in the tick interrupt it is one step. */
inline stop_isr(why, stopped)
{
    if
    :: why == FAULT && cause != FAULT ->
        atomic {
            if
            :: state == BRAKING || state == STOPPING -> state = MOVING
            :: else
            fi
        }
    :: else
    fi;
    atomic {
        if
        :: state == MOVING -> state = BRAKING; stopped = true; accepted = why
        :: else
        fi
    };
    if
    :: stopped -> cause = why
    :: else
    fi
}

active proctype tick()
{
    bool stopped;
    mtype order = NO_CAUSE;

end:
    do
    :: atomic {
        stops > 0 && !held && state != ENDED ->
        stops--;
        if
        :: order = PAUSE
#ifdef FAULTS
        :: order = FAULT
#endif
        fi;
        stop_isr(order, stopped);
        order = NO_CAUSE;
        stopped = false
       }
    od
}

/* What plan_stop has to do after the change. */
inline stop_planned()
{
    atomic {
        !held;
        if
#ifdef PLANT_CAUSE_NOT_COMPARED
        :: result != LATER && state == BRAKING ->
#else
        :: result != LATER && state == BRAKING && cause == why ->
#endif
            state = STOPPING;
            assert(result == RESTS || braked == accepted || (braked == FAULT && accepted == PAUSE))
        :: else
        fi;
        why = NO_CAUSE
    }
}

/* group_stop, up to plan_stop */
inline group_stop()
{
    if
    :: order = PAUSE
#ifdef FAULTS
    :: order = FAULT
#endif
    fi;
#ifdef PLANT_STOP_WITHOUT_HOLD
    stop_isr(order, stopped);
#else
    atomic {
        !held;
        stop_isr(order, stopped)
    };
#endif
    order = NO_CAUSE;
    is_wanted = stopped;
    stopped = false;
    why = cause
}

/* group_resume, up to the change */
inline group_resume()
{
    is_wanted = state == STOPPING;
    atomic {
        !held;
#ifdef PLANT_FAULT_TAKEN_BACK
        resumed = state == BRAKING || state == STOPPING;
#else
        resumed = (state == BRAKING || state == STOPPING) && cause != FAULT;
#endif
        if
        :: resumed ->
            assert(accepted != FAULT);
            state = MOVING;
            why = accepted;
            accepted = NO_CAUSE
        :: else
        fi
    };
    is_wanted = is_wanted && resumed;
    result = CHANGED
}

/* and after it */
inline resume_planned()
{
    atomic {
        if
        :: result != CHANGED && state == MOVING -> state = STOPPING; accepted = why
        :: else
        fi
    };
    atomic {
        !held;
        if
#ifdef PLANT_CAUSE_FORGOTTEN
        :: result == CHANGED && cause == why -> cause = NO_CAUSE
#else
        :: result == CHANGED && state == MOVING -> cause = NO_CAUSE
#endif
        :: else
        fi;
        why = NO_CAUSE
    }
}

/* step_channel_halt of axis `a` */
inline halt()
{
    hold();
    atomic {
        laid = (CH.running -> out[a].waiting : 0);
        if
        :: laid > 0 -> hal_step_take_back(laid)
        :: else
        fi
    };
    atomic {
        much = cursor[CURSOR].pulse - back;
        end_at(much);
        CH.closed = true;
        i = much;
        do
        :: i < path[a].planned -> i++; path[a].intended[i] = 0
        :: else -> break
        od;
        path[a].planned = much;
        path[a].left = 0
    };
    if
    :: laid > 0 -> laid = 0; hal_step_run()
    :: else
    fi;
    release()
}

#define IS_OVER(k) (path[k].left == 0 && !channel[k].running)
#define IS_DONE(k)                                                                                                     \
    (out[k].made == path[k].planned && cursor[k * 3].pulse == out[k].made && out[k].waiting == 0 &&               \
     !channel[k].frozen && channel[k].recalled == 0)

active proctype planner()
{
    byte steps, place, changes = CHANGES, resumes = RESUMES, aborts = ABORTS;
    byte backs[AXES];
    bool in_time, hard, stopped, resumed, is_wanted;
    mtype result = LATER, why = NO_CAUSE, order = NO_CAUSE;

    atomic {
        do
        :: a < AXES ->
            CH.head = COUNTS - 1;
            cursor[CURSOR].tail = CH.head;
            keep_nothing();
            path[a].left = FIRST;
            run hardware(a);
            run interrupt(a);
            a++
        :: else -> break
        od;
        a = 0
    };
    do
    :: path[0].left > 0 && HAS_ROOM(0) -> feed(0)
#if AXES > 1
    :: path[1].left > 0 && HAS_ROOM(1) -> feed(1)
#endif
    :: aborts > 0 -> break
    :: ALL(IS_OVER(0), IS_OVER(1)) -> aborts = 0; break
    :: state == BRAKING || (state == MOVING && changes > 0) || stops > 0 || resumes > 0 ->
        atomic {
            is_wanted = true;
            resumed = false;
            result = LATER
        };
        if
        :: state == BRAKING -> why = cause
        :: atomic { state == MOVING && changes > 0 -> changes-- }
        :: atomic { stops > 0 -> stops-- }; group_stop()
        :: resumes > 0 -> resumes--; group_resume()
        :: else -> is_wanted = false
        fi;
        if
        :: is_wanted -> change()
        :: else
        fi;
        if
        :: resumed -> resume_planned()
        :: !resumed && why != NO_CAUSE -> stop_planned()
        :: else
        fi;
        atomic {
            is_wanted = false;
            resumed = false;
            result = LATER;
            why = NO_CAUSE
        }
    od;
    if
    :: aborts > 0 ->
        do
        :: a < AXES -> halt(); a++
        :: else -> break
        od;
        a = 0;
        ALL(!channel[0].running, !channel[1].running)
    :: else ->
        atomic {
            state = ENDED;
            assert(cause == accepted)
        }
    fi;
    assert(ALL(IS_DONE(0), IS_DONE(1)))
}

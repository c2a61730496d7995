/*
 * A step channel (firmware/engine/step/step_channel.c) between the planner, the tick interrupt and the backend that
 * makes its pulses, for Spin.
 *
 * The planner fills the ring of segments, replaces what is in it and starts the motor where it has come to rest. The
 * backend asks for pulses ahead at any time that no hold is in force, and the hardware makes them at any time at all.
 * Once, between any two steps of the planner, the tick interrupt brakes or halts: pulses are taken back, any number of
 * which the hardware may refuse, what is queued is dropped and the ring is closed; after a brake, until the planner
 * has planned the stop. Spin tries all orders. The step interrupt runs to its end, and the planner waits for the tick
 * interrupt, as on one processor. The counters wrap after COUNTS.
 *
 * A pulse is named by its segment and its place there, and `intended` has the names in the order in which they must be
 * made. So a segment that is lost, taken twice, half written, overwritten while a way back leads over it, or laid after
 * a replacement or a stop is seen, and so is a cursor that stands on another pulse than it counts. The stop-gap of a
 * brake and the stop that is planned for it have the same names. Left out are ticks.
 *
 * PLANT_...: an error, to see that it is found.
 */
#define SEGMENTS 2 /* places in the ring; 32 in the firmware */
#ifdef PLANT_COUNTERS_WRAP_BETWEEN
#define COUNTS 5
#else
#define COUNTS 4 /* 2^32 in the firmware */
#endif
#define AHEAD 2 /* pulses that are laid ahead at most */
#ifndef PUSHES
#define PUSHES 3
#endif
#define STEPS 2 /* pulses of a segment */
#define GAP 1   /* pulses of a stop-gap at most; the stop that is planned has one more at most */
#define STOP (PUSHES + 1)
#define PULSES (PUSHES * STEPS + GAP + 1)
#ifndef REPLACEMENTS
#define REPLACEMENTS 1
#endif
#ifndef STOPS
#define STOPS 1
#endif
#define NEXT(count) ((count + 1) % COUNTS)
#define BEFORE(count) ((count + COUNTS - 1) % COUNTS)
#define DISTANCE(head, tail) ((head + COUNTS - tail) % COUNTS)
#define NAME(segment, place) (segment * 4 + place)

#ifdef PLANT_ROOM_FOR_ONE_MORE
#define HAS_ROOM(head) (DISTANCE(head, taken) <= SEGMENTS)
#else
#define HAS_ROOM(head) (DISTANCE(head, taken) < SEGMENTS)
#endif

typedef slot {
    byte segment;
    byte steps
};

/* The end of its segment is pulse + left. */
typedef step_cursor {
    byte segment;
    byte place; /* in the segment; 0 before the first pulse */
    byte left;
    byte tail;
    byte pulse
};

slot queue[SEGMENTS];
step_cursor cursor, kept[2];
byte young, head, taken;
byte anew; /* the pulse from which was planned anew: no way leads back beyond it */
bool running, closed;

byte waiting, made;  /* the hardware: pulses laid that have not been made, and pulses that have */
bool asking, no_more; /* the backend: asks for pulses; the channel had none left */
bool held, in_tick;

byte intended[PULSES + 1];
byte planned; /* pulses */
bool braking, stopping, reopened;
step_cursor brake_from;
byte gap;

byte laid, back, cut, i; /* of one step, or in a hold */

/* In a hold, only the hardware does anything: what does not look at it is one step. */
#if defined(PLANT_PUSH_WITHOUT_HOLD) || defined(PLANT_REPLACED_WITHOUT_HOLD)
#define HELD
#else
#define HELD atomic
#endif

inline copy(to, from)
{
    to.segment = from.segment;
    to.place = from.place;
    to.left = from.left;
    to.tail = from.tail;
    to.pulse = from.pulse
}

inline advance(c)
{
    if
    :: c.left > 0 ->
        c.left--;
        c.place++
    :: else ->
        c.segment = queue[c.tail % SEGMENTS].segment;
        c.left = queue[c.tail % SEGMENTS].steps - 1;
        c.place = 1;
        c.tail = NEXT(c.tail)
    fi;
    c.pulse++
}

inline advance_to(c, to)
{
    do
    :: c.pulse < to && (c.left > 0 || c.tail != head) -> advance(c)
    :: else -> break
    od
}

inline keep_nothing()
{
    copy(kept[0], cursor);
    copy(kept[1], cursor);
    taken = cursor.tail;
    anew = cursor.pulse
}

/* What comes after a pulse is intended to be the pulses of a segment. */
inline intend(after, whose, count)
{
    planned = after;
    i = 1;
    do
    :: i <= count ->
        planned++;
        intended[planned] = NAME(whose, i);
        i++
    :: else -> break
    od;
    i = planned + 1;
    do
    :: i <= PULSES -> intended[i] = 0; i++
    :: else -> break
    od
}

/* step_channel_lay_isr, from the backend's look at what waits to its care for what has been laid. */
inline lay_isr()
{
#ifdef PLANT_KEPT_TOO_SOON
    if
    :: kept[young].pulse <= cursor.pulse ->
#else
    if
    :: kept[young].pulse <= cursor.pulse - waiting ->
#endif
#ifdef PLANT_TAKEN_FROM_YOUNGER
        taken = cursor.tail;
#else
        taken = kept[young].tail;
#endif
        young = 1 - young;
        copy(kept[young], cursor)
    :: else
    fi;
    laid = 0;
    do
    :: waiting + laid < AHEAD && (cursor.left > 0 || cursor.tail != head) ->
        advance(cursor);
        laid++;
        assert(cursor.pulse <= planned && intended[cursor.pulse] == NAME(cursor.segment, cursor.place))
    :: laid > 0 || (cursor.left == 0 && cursor.tail == head) -> break
    od;
    if
#ifdef PLANT_REST_WHILE_WAITING
    :: laid == 0 ->
#else
    :: laid == 0 && waiting == 0 ->
#endif
        keep_nothing();
        running = false;
        asking = false;
        assert(cursor.left == 0 && cursor.tail == head && waiting == 0)
    :: else -> no_more = laid == 0
    fi;
    waiting = waiting + laid;
    laid = 0
}

inline hold()
{
    atomic { !held -> held = true }
}

inline release()
{
    atomic {
#ifdef PLANT_WAITING_COUNTED
        assert(cursor.pulse == made);
#else
        assert(cursor.pulse - waiting == made);
#endif
        assert(running || (waiting == 0 && cursor.left == 0));
        held = false;
        laid = 0;
        back = 0;
        cut = 0;
        i = 0
    }
}

/* The seam. What has been taken back leaves the backend without a wish for more. */
inline hal_step_run()
{
    atomic {
        asking = true;
        no_more = false;
        if
        :: waiting < AHEAD -> lay_isr()
        :: waiting > 0
        fi
    }
}

inline hal_step_take_back(count)
{
    atomic {
        back = 0;
        do
        :: back < count && back < waiting -> back++
        :: break
        od;
        waiting = waiting - back;
        if
        :: back > 0 -> asking = false
        :: else
        fi
    }
}

active proctype hardware()
{
end:
    do
    :: atomic { waiting > 0 -> waiting--; made++ }
    od
}

active proctype interrupt()
{
end:
    do
    :: atomic { asking && !held && waiting < AHEAD && (!no_more || waiting == 0) -> lay_isr() }
    od
}

/* step_channel_find_pulse; `since` is before the pulse made last, or after it. */
inline find_pulse(c, found, so_far, since)
{
    atomic {
        !held -> found = running;
        so_far = cursor.pulse - waiting;
        if
        :: running && kept[young].pulse <= so_far -> copy(c, kept[young])
        :: running && kept[young].pulse > so_far -> copy(c, kept[1 - young])
        :: !running -> copy(c, cursor)
        fi;
        assert(!running || c.pulse <= so_far || c.pulse == anew)
    };
    atomic { advance_to(c, so_far) };
    atomic {
        if
        :: found && c.pulse == so_far && since && so_far > 0
        :: found && c.pulse == so_far -> advance_to(c, (so_far + 1))
        :: !found || c.pulse != so_far
        fi;
        assert(!found || closed || c.place == 0 || intended[c.pulse] == NAME(c.segment, c.place));
        so_far = 0
    }
}

/* channel_take_back; `back` tells whether there was any. */
inline take_back(at)
{
    if
    :: at.pulse < cursor.pulse -> hal_step_take_back(cursor.pulse - at.pulse)
    :: else
    fi;
    atomic {
        if
        :: back > 0 ->
            laid = cursor.pulse;
            copy(cursor, at);
#ifndef PLANT_ALL_TAKEN_BACK
            advance_to(cursor, (laid - back));
            assert(cursor.pulse == laid - back);
#endif
#ifndef PLANT_KEPT_NOT_MOVED
            if
            :: kept[young].pulse > laid - back -> copy(kept[young], cursor)
            :: else
            fi;
#endif
            laid = 0
        :: else
        fi
    }
}

inline end_with(c, to)
{
    if
    :: c.tail == cursor.tail && to < c.pulse + c.left ->
        assert(c.pulse <= to);
        c.left = to - c.pulse
    :: else
    fi
}

/* channel_truncate */
inline truncate(last)
{
    atomic {
#ifndef PLANT_QUEUED_COPY_KEPT
        if
        :: kept[1 - young].tail != cursor.tail && last < cursor.pulse + cursor.left ->
            cut = cursor.pulse + cursor.left - last;
            assert(queue[BEFORE(cursor.tail) % SEGMENTS].steps > cut);
            queue[BEFORE(cursor.tail) % SEGMENTS].steps = queue[BEFORE(cursor.tail) % SEGMENTS].steps - cut
        :: else
        fi;
#endif
        end_with(kept[0], last);
        end_with(kept[1], last);
        end_with(cursor, last);
        cut = last - cursor.pulse - cursor.left; /* pulses to be kept in the queue */
        head = cursor.tail;
        do
        :: cut > 0 ->
            if
            :: cut < queue[head % SEGMENTS].steps -> queue[head % SEGMENTS].steps = cut
            :: else
            fi;
            cut = cut - queue[head % SEGMENTS].steps;
            head = NEXT(head)
        :: else -> break
        od
    }
}

/* find_pulse and step_channel_brake, as the axis brakes. */
inline brake(found, so_far)
{
    find_pulse(brake_from, found, so_far, true);
    if
    :: found ->
        hold();
        if
        :: running ->
            take_back(brake_from);
            atomic {
                copy(brake_from, cursor);
                select(gap: 0 .. GAP);
                intend(cursor.pulse, STOP, gap);
                cursor.segment = STOP;
                cursor.place = 0;
                cursor.left = gap;
#ifndef PLANT_LAID_AFTER_CLOSE
                head = cursor.tail;
#endif
                closed = true;
                braking = true;
#ifndef PLANT_WAY_BACK_OVER_BRAKE
                keep_nothing()
#endif
            };
            hal_step_run()
        :: else
        fi;
        release()
    :: else
    fi;
    found = false
}

inline halt()
{
    hold();
    atomic {
        if
        :: running -> laid = waiting
        :: else
        fi
    };
    if
    :: laid > 0 -> hal_step_take_back(laid)
    :: else
    fi;
    atomic {
        cursor.pulse = cursor.pulse - back;
        cursor.left = 0;
        cursor.place = 0;
#ifndef PLANT_HALT_KEEPS_QUEUE
        head = cursor.tail;
#endif
        intend(cursor.pulse, STOP, 0);
        keep_nothing();
        closed = true
    };
    if
#ifdef PLANT_HALT_RESTS
    :: laid > 0 -> running = false
#else
#ifndef PLANT_HALT_NOT_RUN
    :: laid > 0 -> hal_step_run()
#endif
#endif
    :: else
    fi;
    release()
}

active proctype tick()
{
    byte so_far;
    bool found;

end:
    atomic { STOPS > 0 && !held -> in_tick = true };
    if
    :: brake(found, so_far); stopping = true
    :: halt()
    fi;
    in_tick = false
}

/* channel_push */
inline put(new, count)
{
    intend(planned, new, count);
#ifdef PLANT_SEEN_BEFORE_WRITTEN
    head = NEXT(head);
    queue[BEFORE(head) % SEGMENTS].segment = new;
    queue[BEFORE(head) % SEGMENTS].steps = count
#else
    queue[head % SEGMENTS].segment = new;
    queue[head % SEGMENTS].steps = 0; /* half written */
    queue[head % SEGMENTS].steps = count;
    head = NEXT(head)
#endif
}

/* step_channel_push; the room has been seen before. */
inline push()
{
#ifdef PLANT_CLOSED_SEEN_BEFORE_HOLD
    refused = closed;
#endif
    HELD {
#ifndef PLANT_PUSH_WITHOUT_HOLD
        hold();
#endif
#ifndef PLANT_CLOSED_SEEN_BEFORE_HOLD
        refused = closed;
#endif
        name++;
        if
#ifdef PLANT_CLOSED_NOT_SEEN
        :: true -> put(name, STEPS)
#else
        :: !refused -> put(name, STEPS)
        :: refused -> assert(!reopened)
#endif
        fi;
#ifndef PLANT_PUSH_WITHOUT_HOLD
        release();
#endif
        refused = false
    }
}

/* step_channel_look_ahead and step_channel_replace, by one segment or, if there is no more, by none. */
inline replace()
{
    find_pulse(at, found, so_far, false);
    do
    :: found && !closed && (at.left > 0 || at.tail != head) -> atomic { advance(at) }
    :: break
    od;
    if
    :: found ->
#ifndef PLANT_REPLACED_WITHOUT_HOLD
        hold();
#endif
        atomic {
            count = (name < PUSHES -> 1 : 0);
#ifdef PLANT_REPLACED_AFTER_BRAKE
            in_time = running && (DISTANCE(at.tail, taken) + count) % COUNTS <= SEGMENTS
#else
            in_time = running && !closed && (DISTANCE(at.tail, taken) + count) % COUNTS <= SEGMENTS
#endif
        };
        if
        :: in_time -> take_back(at)
        :: else
        fi;
#ifndef PLANT_NOT_LOOKED_AGAIN
        in_time = in_time && cursor.pulse <= at.pulse;
#endif
        if
        :: in_time ->
            truncate(at.pulse);
            HELD {
                planned = at.pulse;
                if
                :: count > 0 -> name++; put(name, STEPS)
                :: else -> intend(planned, STOP, 0)
                fi
            }
        :: else
        fi;
        if
#ifdef PLANT_BACK_NOT_RUN
        :: in_time -> hal_step_run()
#else
        :: in_time || back > 0 -> hal_step_run()
#endif
        :: else
        fi;
#ifndef PLANT_REPLACED_WITHOUT_HOLD
        release();
#endif
    :: else
    fi;
    atomic {
        found = false;
        in_time = false;
        count = 0;
        at.segment = 0;
        at.place = 0;
        at.left = 0;
        at.tail = 0;
        at.pulse = 0
    }
}

inline start()
{
    atomic {
        hold();
        running = true;
        hal_step_run();
        release()
    }
}

inline replace_brake()
{
    atomic {
        hold();
#ifndef PLANT_NOT_OPENED
        closed = false;
#endif
        reopened = true;
        laid = cursor.pulse - brake_from.pulse;
        count = (gap > 0 -> gap : 1);
        if
        :: count++
        :: true
        fi;
        assert(laid <= count)
    };
    if
    :: laid > 0 || !running ->
        atomic {
            cursor.segment = STOP;
            cursor.place = laid;
            cursor.left = count - laid;
            keep_nothing();
            intend(brake_from.pulse, STOP, count)
        }
    :: else ->
        truncate(cursor.pulse);
        atomic {
            planned = cursor.pulse;
            put(STOP, count)
        }
    fi;
    running = true;
    hal_step_run();
    release();
    count = 0
}

/* plan_stop of the axis. A motor that was at rest when the stop came brakes now, or stays where it is. */
inline plan_stop()
{
    stopping = false;
    if
    :: !closed -> brake(found, so_far)
    :: else
    fi;
    if
    :: braking -> replace_brake()
    :: !braking && !running -> halt()
    :: else
    fi;
    braking = false
}

active proctype planner() provided (!in_tick)
{
    byte name, so_far, count, seen, replacements = REPLACEMENTS;
    bool refused, found, in_time;
    step_cursor at;

    atomic {
        head = COUNTS - 1;
        cursor.tail = head;
        keep_nothing()
    };
    do
    :: stopping -> plan_stop()
    :: name < PUSHES ->
        seen = head;
        if
        :: HAS_ROOM(seen) -> seen = 0; push()
        :: else -> seen = 0
        fi
    :: replacements > 0 && running -> replacements--; replace()
#ifndef PLANT_NOT_STARTED_AGAIN
    :: !running && head != taken -> start()
#else
    :: !running && head != taken && cursor.pulse == 0 -> start()
#endif
    :: name == PUSHES && !running && head == taken && !stopping -> break
    od;
    assert(made == planned && cursor.pulse == made && waiting == 0)
}

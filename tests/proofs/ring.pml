/*
 * The ring of segments between main and the step interrupt (firmware/engine/step/step_channel.c), for Spin.
 *
 * Main fills the ring, replaces what is in it and starts the motor where it has come to rest; the step interrupt
 * empties it. The tick interrupt may brake once, between any two steps of main: it drops what is queued and closes the
 * ring, until main has planned the stop, puts its first segment in the place of the present one and opens the ring for
 * the others; or, where the motor rests, until the next move. Each access to what they share is a step of its own, and
 * Spin tries all orders of the steps of all, as if they ran on processors of their own; only a hold keeps them apart.
 * Accesses are seen in the order in which they are made. The counters begin at any value and wrap after COUNTS.
 *
 * A slot holds the name of its segment and `intended` the names in the order in which they must be taken, so a segment
 * that is lost, taken twice, taken after a replacement, half written or overwritten too soon is seen. What a segment
 * does is left out: the pulses in it are no concern of the ring.
 *
 * PLANT_...: an error, to see that it is found.
 */
#define SEGMENTS 2 /* places in the ring; 32 in the firmware */
#ifdef PLANT_COUNTERS_WRAP_BETWEEN
#define COUNTS 5
#else
#define COUNTS 4 /* 2^32 in the firmware */
#endif
#define PUSHES 5
#define REPLACEMENTS 2
#ifndef BRAKES
#define BRAKES 1
#endif
#define NEXT(count) ((count + 1) % COUNTS)
#define QUEUED(head, taken) ((head + COUNTS - taken) % COUNTS)

#ifdef PLANT_ROOM_FOR_ONE_MORE
#define HAS_ROOM (QUEUED(head, taken) <= SEGMENTS)
#else
#define HAS_ROOM (QUEUED(head, taken) < SEGMENTS)
#endif

byte queue[SEGMENTS];
byte head, taken, tail;
bool running = false, armed = false;
bool present = false; /* not armed, and the present segment has a pulse left */
bool held = false, inside = false;
bool closed = false, braking = false, stopping = false;
bool replaced = false; /* the stop has been planned: no segment is refused any more */

byte intended[PUSHES + 1];
byte begun = 0;  /* segments taken in all: the place in `intended` of the next */
byte pushed = 0; /* the place in `intended` of the next that is put in */

/* step_channel_next_segment: in the interrupt, or in main while no pulse is armed. */
inline take(seen)
{
    armed = false;
    seen = head;
    if
    :: seen == tail -> running = false
    :: else ->
#ifdef PLANT_TAKEN_TOO_SOON
        taken = NEXT(tail);
#endif
        assert(queue[tail % SEGMENTS] == intended[begun]);
        atomic { begun++; tail = NEXT(tail) };
        taken = tail;
        armed = true
    fi
}

active proctype interrupt()
{
    byte seen;

end:
    do
    :: atomic { armed && !held -> inside = true };
        take(seen);
        atomic { inside = false; seen = 0 }
    od
}

inline hold()
{
    atomic { !inside && !held -> held = true }
}

/* step_channel_run: the next pulse, on the present segment or the first of the next. */
inline start(seen)
{
    hold();
    running = true;
    if
    :: present -> present = false; armed = true
    :: take(seen)
    fi;
    held = false
}

/* What is left of step_channel_brake in its hold, if the motor moves: the present segment becomes the stop-gap. The
 * armed pulse may be taken back; then the motor is to be started again. */
inline brake_held(back)
{
    if
    :: running ->
        if
        :: armed -> armed = false; back = true; present = true
        :: true
        fi;
        head = tail;
        pushed = begun;
        closed = true;
        braking = true
    :: else
    fi
}

active proctype tick()
{
    byte seen;
    bool back = false;

end:
    atomic { BRAKES > 0 && !inside && !held -> held = true };
    brake_held(back);
    held = false;
    if
    :: back -> start(seen)
    :: else
    fi;
    stopping = true
}

inline put()
{
    atomic {
        name++;
        if
        :: closed /* not wanted any more */
        :: else -> intended[pushed] = name; pushed++
        fi
    };
#ifdef PLANT_SEEN_BEFORE_WRITTEN
    head = NEXT(head);
    queue[(head + COUNTS - 1) % COUNTS % SEGMENTS] = name
#else
    queue[head % SEGMENTS] = 0; /* half written */
    queue[head % SEGMENTS] = name;
    head = NEXT(head)
#endif
}

/* step_channel_push; the room has been seen before. */
inline push()
{
#ifdef PLANT_CLOSED_SEEN_BEFORE_HOLD
    refused = closed;
    hold();
#else
#ifndef PLANT_PUSH_WITHOUT_HOLD
    hold();
#endif
    refused = closed;
#endif
    if
#ifdef PLANT_CLOSED_NOT_SEEN
    :: true -> put()
#else
    :: !refused -> put()
    :: refused -> assert(!replaced); name++
#endif
    fi;
    held = false;
    refused = false
}

/* plan_stop of the axis. A motor that was at rest when the stop came brakes now, or stays where it is. */
inline plan_stop(seen)
{
    stopping = false;
    if
    :: !braking ->
        hold();
        brake_held(back);
        held = false;
        if
        :: back -> back = false; start(seen)
        :: else
        fi
    :: else
    fi;
    if
    :: braking -> /* step_channel_replace_brake */
        hold();
#ifndef PLANT_NOT_OPENED
        closed = false;
#endif
        replaced = true;
        rests = !running;
        if
        :: rests ->
            if
            :: present = true /* it has pulses that the stop-gap has not made */
            :: true
            fi
        :: else
        fi;
        held = false;
        if
        :: rests -> rests = false; start(seen)
        :: else
        fi
    :: !braking && !running -> /* step_channel_halt */
        hold();
        head = tail;
        pushed = begun;
        closed = true;
        held = false
    :: else
    fi;
    braking = false
}

active proctype main()
{
    byte name = 0, replacements = REPLACEMENTS, at, seen;
    bool refused = false, back = false, rests = false;

    atomic {
        select(head: 0 .. COUNTS - 1);
        taken = head;
        tail = head
    };
    do
    :: stopping -> plan_stop(seen)
    :: name < PUSHES && HAS_ROOM -> push()
    :: replacements > 0 && running ->
        replacements--;
        hold();
        at = begun; /* step_channel_look_ahead: the armed pulse, or one of a later segment */
        held = false;
        do
        :: at < pushed -> at++
        :: break
        od;
#ifndef PLANT_REPLACED_WITHOUT_HOLD
        hold();
#endif
        if
#ifdef PLANT_NOT_LOOKED_AGAIN
        :: running && !closed ->
#else
#ifdef PLANT_REPLACED_AFTER_BRAKE
        :: running && begun <= at ->
#else
        :: running && !closed && begun <= at ->
#endif
#endif
            head = (tail + COUNTS + at - begun) % COUNTS;
            pushed = at;
            if
            :: name < PUSHES && HAS_ROOM -> put()
            :: else
            fi
        :: else
        fi;
        held = false;
        at = 0
#ifndef PLANT_NOT_STARTED_AGAIN
    :: !running && head != taken ->
#else
    :: !running && head != taken && begun == 0 ->
#endif
        start(seen)
    :: name == PUSHES && !running && head == taken && !stopping -> break
    od;
    assert(begun == pushed)
}

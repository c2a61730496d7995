/*
 * The ring of segments between main and the step interrupt (firmware/step/step_channel.c), for Spin.
 *
 * Main fills the ring, cuts it and starts the motor where it has come to rest; the interrupt empties it. Each access to
 * what they share is a step of its own, and Spin tries all orders of the steps of both, as if they ran on two
 * processors; only a hold keeps them apart. Accesses are seen in the order in which they are made. The counters begin
 * at any value and wrap after COUNTS.
 *
 * A slot holds the name of its segment and `intended` the names in the order in which they must be taken, so a segment
 * that is lost, taken twice, taken after a cut, half written or overwritten too soon is seen. What a segment does is
 * left out: the pulses in it are no concern of the ring.
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
#define CUTS 2
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
bool held = false, inside = false;

byte intended[PUSHES + 1];
byte begun = 0; /* segments taken in all: the place in `intended` of the next */

/* step_channel_next_segment_isr: in the interrupt, or in main while no pulse is armed. */
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
    atomic { !inside -> held = true }
}

inline push()
{
    atomic { name++; intended[pushed] = name; pushed++ };
#ifdef PLANT_SEEN_BEFORE_WRITTEN
    head = NEXT(head);
    queue[(head + COUNTS - 1) % COUNTS % SEGMENTS] = name
#else
    queue[head % SEGMENTS] = 0; /* half written */
    queue[head % SEGMENTS] = name;
    head = NEXT(head)
#endif
}

active proctype main()
{
    byte pushed = 0, name = 0, cuts = CUTS, at, seen;

    atomic {
        select(head: 0 .. COUNTS - 1);
        taken = head;
        tail = head
    };
    do
    :: name < PUSHES && HAS_ROOM -> push()
    :: cuts > 0 && running ->
        cuts--;
        hold();
        at = begun; /* step_channel_foresee: the armed pulse, or one of a later segment */
        held = false;
        do
        :: at < pushed -> at++
        :: break
        od;
#ifndef PLANT_CUT_WITHOUT_HOLD
        hold();
#endif
        if
#ifdef PLANT_NOT_LOOKED_AGAIN
        :: running ->
#else
        :: running && begun <= at ->
#endif
            head = (tail + COUNTS + at - begun) % COUNTS;
            pushed = at;
            if
            :: name < PUSHES && HAS_ROOM -> push()
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
        running = true;
        take(seen)
    :: name == PUSHES && !running && head == taken -> break
    od;
    assert(begun == pushed)
}

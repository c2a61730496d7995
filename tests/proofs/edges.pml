/*
 * The edges of a motor (hal/stm32/stm32_step.c) between the step interrupt, what takes pulses back, the stream of the
 * DMA and the timer, for Spin.
 *
 * The stream moves words of the ring into the compare register, one at each match, and has loaded the next one by then.
 * The interrupt lays pulses after those that the ring has; whoever holds the interrupt off takes pulses back and lays
 * others. The counter goes on meanwhile, and the stream moves a word at once or after SETTLE: Spin tries all orders.
 * From a look at the counter to a write, the processor takes less than the constant that stands for it.
 *
 * A pulse has an ordinal, and `due` has the tick at which each must rise. So an edge that is missing, made twice, made
 * though it was taken back, too near to another or too late in the compare register is seen. Left out are the ways of
 * DIR, and that there are four motors.
 *
 * LATE: the interrupt may come at any time. Otherwise it comes in time, and no pulse may be late.
 * PLANT_...: an error, to see that it is found.
 */
#define RING 6 /* pulses; 64 at least in the firmware */
#define EDGES (2 * RING)
#define LAY_MAX 2
#define WAITING_MAX (RING - 2 - LAY_MAX)
#define NEVER 0

/* Steps of the counter, each of many ticks. */
#define HIGH 2
#define LOW 2
#define SETTLE 1
#define APPEND 2
#define START 3
#define REACT 2
#define CUT (REACT + APPEND)
#define STOP (REACT + START)
#define LEAD 5
#define LATENCY 1 /* of the interrupt */
#ifdef FAR
#define NEAR 24
#define HORIZON 40
#else
#define NEAR 8
#define HORIZON 12
#endif

#ifndef PULSES
#define PULSES 5 /* that are laid, those included that are taken back */
#endif
#ifndef CHANGES
#define CHANGES 1
#endif

#define RISE(pulse) ((pulse) % RING * 2)
#define FALL(pulse) (RISE(pulse) + 1)

/* The hardware. */
byte ring[EDGES];
byte now = 30;
byte compare, loaded;
byte arrived; /* words that have come into the compare register, modulo the ring: what NDTR tells */
byte moving;  /* the stream: 1: asked for a word; 2: has moved it, and loads the next */
byte matched; /* the tick at which it was asked */
bool asks, toggles, high;

/* The channel. */
byte laid, last_tick, from_tick, due_tick;
bool runs, ends;

/* The client. */
byte budget = PULSES; /* that it may lay */
byte next_tick, gap;

byte due[PULSES + 1];
byte before; /* pulses before the stream was started */
byte made;   /* pulses that have risen */
byte fallen; /* the tick at which the pin fell last */
byte late;
bool in_doubt; /* a pulse was moved on that the stream may have loaded */
bool failed;

/* The processor is at work, and comes further by then. */
bool busy;
byte deadline;

#define AT_REST (!runs && budget == 0)
#ifdef LATE
#define IN_TIME (now < last_tick + HIGH + LOW + SETTLE + START)
#else
#define IN_TIME (runs && now < due_tick + LATENCY)
#endif
#define MAY_PASS (busy || IN_TIME || (AT_REST && now < compare))

inline match()
{
    if
    :: toggles && !high ->
        assert(in_doubt || (made < before + laid && now == due[made]));
        assert(in_doubt || made == 0 || now >= fallen + LOW);
        made++;
        high = true
    :: toggles && high ->
        assert(in_doubt || now == due[made - 1] + HIGH);
        fallen = now;
        high = false
    :: else
    fi;
    if
    :: asks ->
        assert(in_doubt || moving == 0);
        moving = 1;
        matched = now
    :: else
    fi
}

active proctype counter()
{
end:
    do
    :: atomic {
        !failed && MAY_PASS && (!busy || now < deadline) && (moving == 0 || now < matched + SETTLE) ->
            now++;
            if
            :: compare == now -> match()
            :: else
            fi
        }
    od
}

active proctype stream()
{
end:
    do
    :: atomic {
        moving == 1 ->
            compare = loaded;
            assert(in_doubt || !toggles || compare == NEVER || compare > now);
            arrived = (arrived + 1) % EDGES;
            moving = 2
        }
    :: atomic {
        moving == 2 ->
            loaded = ring[arrived];
            moving = 0
        }
    od
}

inline look(time)
{
    atomic {
        busy = true;
        deadline = now + time - 1
    }
}

/* stm32_fault_stop_output */
inline fail()
{
    atomic {
        toggles = false;
        high = false;
        failed = true;
        assert(late > 0)
    }
}

inline count_waiting(result)
{
#ifdef PLANT_MADE_TOO_SOON
    result = (laid + RING - (arrived + 1) / 2 % RING) % RING
#else
    result = (laid + RING - arrived / 2) % RING
#endif
}

inline check_made(expected)
{
    atomic {
        count_waiting(found);
        if
        :: found != expected -> fail()
        :: else
        fi;
        found = 0
    }
}

/* What is left in the channel once the stream has stopped. */
inline stop()
{
#ifndef PLANT_PIN_LEFT
    atomic {
        toggles = false;
        assert(!high || failed)
    };
#endif
    asks = false;
    atomic {
        moving = 0;
        runs = false;
        before = before + laid;
        laid = 0
    }
}

inline start()
{
    atomic {
#ifndef PLANT_COUNT_KEPT
        arrived = 0;
#endif
        loaded = ring[arrived];
        compare = NEVER;
        asks = true;
        moving = 1;
        matched = now;
        runs = true
    };
    toggles = true
}

inline make_good(first, pulses, earliest)
{
    least = earliest;
    k = 0;
    do
    :: k < pulses && ring[RISE(first + k)] < least ->
#ifndef LATE
        assert(false);
#endif
        atomic {
            late++;
            in_doubt = runs;
            ring[RISE(first + k)] = least;
            due[before + first + k] = least
        };
        ring[FALL(first + k)] = least + HIGH;
        least = least + HIGH + LOW;
        k++
    :: else -> break
    od;
    k = 0
}

/* lay_isr. The first word of the ring is written in time, and each other pulse a little later. */
inline ask(ahead)
{
    count = 0;
    until = now + ahead;
    do
    :: count < LAY_MAX && budget > 0 && (count == 0 || next_tick < until + gap) ->
        atomic {
            ring[RISE(laid + count)] = next_tick;
            due[before + laid + count] = next_tick;
            budget--;
            deadline = (runs -> now + 1 : deadline)
        };
        ring[FALL(laid + count)] = next_tick + HIGH;
        atomic {
            count++;
            if
            :: gap = HIGH + LOW
            :: gap = 2 * (HIGH + LOW) + 1
            fi;
            next_tick = next_tick + gap
        }
    :: else -> break
    od
}

inline note_laid(pulses)
{
    atomic {
        laid = pulses;
        last_tick = ring[RISE(laid + RING - 1)];
        from_tick = last_tick - NEAR;
        due_tick = last_tick - LEAD;
        ends = false
    };
#ifndef PLANT_NO_LAST_EDGE
    ring[RISE(laid)] = NEVER
#endif
}

inline note_end()
{
    atomic {
#ifdef PLANT_END_NOT_AWAITED
        from_tick = last_tick;
#else
        from_tick = last_tick + HIGH + SETTLE;
#endif
        due_tick = from_tick;
        ends = true
    }
}

inline begin(ahead)
{
    if
    :: !busy -> look(APPEND)
    :: busy
    fi;
    ask(ahead);
    if
    :: count > 0 ->
        look(START - SETTLE);
        atomic {
            tick = now + START;
            if
            :: now >= last_tick && tick < last_tick + HIGH + LOW -> tick = last_tick + HIGH + LOW
            :: else
            fi
        };
        make_good(0, count, tick);
        note_laid(count);
        start()
    :: else
    fi
}

inline append(ahead)
{
    atomic {
        look(APPEND);
        count_waiting(waiting);
        tick = last_tick;
        count = 0;
#ifdef PLANT_NOT_IN_TIME
        in_time = true
#else
        in_time = tick >= now + APPEND
#endif
    };
    if
#ifdef PLANT_RING_OVERRUN
    :: false
#else
    :: waiting > WAITING_MAX -> from_tick = ring[RISE(laid + RING - WAITING_MAX)]
#endif
    :: else ->
        if
        :: in_time -> ask(ahead)
        :: else
        fi;
        if
        :: count == 0 -> note_end()
        :: else ->
            make_good(laid, count, tick + HIGH + LOW);
            note_laid(laid + count);
#ifndef PLANT_LOADED_NOT_CHECKED
            if
            :: tick <= now -> /* within a step of the counter, the stream may have been first */
                deadline = (now < tick + HIGH + SETTLE -> tick + HIGH + SETTLE : now);
                now >= tick + HIGH + SETTLE;
                if
                :: in_doubt || compare == NEVER -> fail()
                :: else
                fi
            :: else
            fi;
#endif
            in_doubt = false
        fi
    fi
}

inline refill(ahead)
{
    if
    :: runs && ends && now >= from_tick ->
        look(START);
        check_made(0);
        stop();
        busy = false
    :: else
    fi;
    if
    :: failed
    :: !failed && !runs -> begin(ahead)
    :: !failed && runs && !ends -> append(ahead)
    :: !failed && runs && ends
    fi
}

/* hal_step_run */
inline lay_more()
{
    if
    :: runs && ends -> note_laid(laid)
    :: else
    fi;
    if
    :: !runs || now >= from_tick -> refill(2 * LEAD)
    :: else
    fi
}

/* hal_step_take_back, of `back` pulses at most. */
inline take_back()
{
    atomic {
        look(REACT);
        seen = now;
        count_waiting(waiting);
        assert(waiting == before + laid - made || waiting == before + laid - made + 1);
        back = (back < waiting -> back : waiting)
    };
    do
    :: back == 0 || gone -> break
#ifdef PLANT_LOADED_IS_CUT
    :: back > 0 && !gone && back < waiting && ring[RISE(laid - back)] >= seen + CUT ->
#else
#ifdef PLANT_CUT_TOO_LATE
    :: back > 0 && !gone && back < waiting && ring[RISE(laid - back - 1)] > seen ->
#else
    :: back > 0 && !gone && back < waiting && ring[RISE(laid - back - 1)] >= seen + CUT ->
#endif
#endif
        note_laid(laid - back);
        gone = true
    :: else ->
        atomic {
            tick = seen;
            if
            :: laid > back && ring[FALL(laid - back - 1)] + SETTLE > seen -> tick = ring[FALL(laid - back - 1)] + SETTLE
            :: else
            fi
        };
        if
#ifdef PLANT_TAKEN_BACK_TOO_LATE
        :: ring[RISE(laid - back)] <= tick -> back--
#else
        :: ring[RISE(laid - back)] < tick + STOP -> back--
#endif
        :: else ->
#ifndef PLANT_PULSE_NOT_AWAITED
            deadline = (tick > now -> tick : now);
            now >= tick;
#endif
            atomic {
                deadline = (tick > seen -> tick : seen) + REACT - 1;
                last_tick = (laid > back -> ring[RISE(laid - back - 1)] : last_tick)
            };
            check_made(back);
            laid = laid - back;
            stop();
            gone = true
        fi
    od;
    assert(made <= before + laid)
}

/* What comes instead of the pulses taken back is due later, or there is nothing more. */
inline change()
{
    take_back();
    if
    :: back > 0 && !failed ->
        atomic {
            next_tick = due[before + laid];
            if
            :: next_tick = next_tick + 2
            :: true
            :: budget = 0
            fi
        };
        lay_more()
    :: else
    fi
}

inline done()
{
    atomic {
        busy = false;
        deadline = 0;
        count = 0;
        waiting = 0;
        tick = 0;
        least = 0;
        until = 0;
        seen = 0;
        back = 0;
        gone = false;
        in_time = false
    }
}

active proctype processor()
{
    byte count, waiting, found, tick, least, until, seen, back, k, changes = CHANGES;
    bool gone, in_time;

#ifdef LATE
    next_tick = now + 1;
#else
    next_tick = now + APPEND + START;
#endif
    do
    :: failed -> break
    :: !failed && !runs && budget == 0 -> break
    :: !failed && !runs && budget > 0 -> lay_more(); done()
    :: !failed && runs && now >= from_tick -> refill(HORIZON); done()
    :: !failed && runs && changes > 0 ->
        atomic {
            changes--;
            select(back: 1 .. 3)
        };
        change();
        done()
    od;
    assert(failed || (made == before && !high))
}

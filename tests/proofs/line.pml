/*
 * The line between one master and one unit (firmware/docs/line.md, "Repeats"), for Spin.
 *
 * The line may lose, damage and repeat any frame, in both directions, and holds up to two each way; it does not
 * overtake. The unit may start anew at any time, and so may the master, in the middle of anything. Every choice that
 * is open stands as a choice here, and Spin tries them all.
 *
 * The master may send a broadcast before any request and before each repeat of it.
 *
 * The master's user wants ACTIONS things done, each of a kind. All those of one kind are the same message, so the
 * unit can only tell them by the number; `id` tells them here, and nobody in the model decides by it.
 *
 * Switches. LATE: the master may stop waiting while frames are still under way. ACROSS: an action counts as executed
 * twice also where the unit has started anew in between. AT_MOST_ONCE: an answer need not be the one to this very
 * action. SESSION_FIRST: a unit that has started executes no numbered request before Version. PLANT_...: an error, to see that it is found.
 */
#ifndef ACTIONS
#define ACTIONS 3
#endif
#define ATTEMPTS 2
#define NUMBERS 3       /* 255 on the line; fewer meet again sooner */
#define REPETITIONS 1   /* by the line itself */
#define NO_NUMBER 0
#define NO_ID 0

mtype = { VERSION, SET, READ, STOP, BROADCAST };

/* number, message, whose it is (of an answer: what was executed for it), whether it is damaged */
chan requests = [2] of { byte, mtype, byte, bool };
chan answers = [2] of { byte, mtype, byte, bool };

byte in_this_life[ACTIONS + 1]; /* how often the unit has executed each action since it started */
byte in_all[ACTIONS + 1];
byte repetitions = REPETITIONS;
byte unit_starts = 1;
byte master_starts = 1;
#ifdef LATE
byte broadcasts = 0;
#else
byte broadcasts = 1; /* before any request */
#endif

inline carry(line, number, message, id)
{
    if
    :: line!number, message, id, false
    :: line!number, message, id, true
    :: skip /* lost */
    :: repetitions > 0 && empty(line) ->
        repetitions--; line!number, message, id, false; line!number, message, id, false
    fi
}

active proctype unit()
{
    byte kept_number = NO_NUMBER, kept_id = NO_ID; /* of the request answered last; whose the stored answer is */
    mtype kept_message = VERSION;
    byte number, id;
    mtype message;
    bool damaged, begun = false; /* a Version has come since the start */

end:
    do
    :: atomic {
        requests?number, message, id, damaged ->
        if
#ifndef PLANT_NO_CHECK
        :: damaged -> skip
        :: !damaged && message == BROADCAST ->
#else
        :: message == BROADCAST ->
#endif
            assert(!damaged);
            if
            :: kept_message == READ -> /* too long to be put aside */
                kept_id = id;
#ifndef PLANT_ANSWER_KEPT
                kept_number = NO_NUMBER
#endif
            :: else
            fi
        :: else ->
            if
#if defined(PLANT_NO_MEMORY)
            :: false -> skip
#elif defined(PLANT_NUMBER_NOT_COMPARED)
            :: kept_number != NO_NUMBER && message == kept_message -> carry(answers, number, message, kept_id)
#else
            :: kept_number != NO_NUMBER && number == kept_number && message == kept_message ->
                carry(answers, number, message, kept_id)
#endif
#ifdef SESSION_FIRST
            :: !begun && number != NO_NUMBER && message != VERSION -> skip
#endif
            :: else ->
                assert(!damaged);
#ifdef ACROSS
                assert(message != SET || in_all[id] == 0);
#else
                assert(message != SET || in_this_life[id] == 0);
#endif
                if
                :: message == SET -> in_this_life[id]++; in_all[id]++
                :: else
                fi;
                begun = begun || message == VERSION;
                kept_number = number;
                kept_message = message;
                kept_id = id;
                carry(answers, number, message, kept_id)
            fi
        fi;
        number = 0; id = NO_ID; message = VERSION; damaged = false /* fewer states */
       }
    :: atomic { unit_starts > 0 -> /* as answers may be lost, that is in the middle of a request too */
            unit_starts--;
            kept_number = NO_NUMBER; kept_id = NO_ID; kept_message = VERSION; begun = false;
            byte i = 0;
            do
            :: i <= ACTIONS -> in_this_life[i] = 0; i++
            :: else -> break
            od;
            i = 0
        }
    od
}

#ifdef LATE
#define NOTHING_COMES true
#else
#define NOTHING_COMES (empty(requests) && empty(answers))
#endif

/* Sends a request until an answer to it comes, ATTEMPTS times; `answered` tells. */
inline exchange(number, message, id)
{
    answered = false;
    attempts = ATTEMPTS;
    do
    :: attempts > 0 && !answered ->
        atomic { attempts--;
        do /* what has come until now and was not asked for; the rest of it is still under way */
        :: nempty(answers) -> answers?_, _, _, _
        :: break
        od;
        if
        :: broadcasts > 0 && nfull(requests) -> broadcasts--; requests!NO_NUMBER, BROADCAST, NO_ID, false
        :: skip
        fi;
#ifdef PLANT_NEW_NUMBER
        number = number % NUMBERS + 1;
#endif
        carry(requests, number, message, id) };
        do
        :: atomic { answers?got_number, got_message, got_id, damaged ->
            if
            :: !damaged && got_number == number && got_message == message -> answered = true; break
            :: else -> got_number = 0; got_id = NO_ID; got_message = VERSION; damaged = false
            fi }
        :: NOTHING_COMES -> break
        :: atomic { NOTHING_COMES && master_starts > 0 -> master_starts--; session = false; goto next }
        od
    :: else -> break
    od
}

active proctype master()
{
    bool session = false, answered, damaged;
    byte number, got_number, got_id, attempts, no_number = NO_NUMBER;
    byte id = NO_ID;
    mtype wanted, got_message;

next:
    do
    :: id < ACTIONS ->
        atomic { id++;
        got_number = 0; got_id = NO_ID; got_message = VERSION; damaged = false;
        if
        :: wanted = SET
        :: wanted = READ
        :: wanted = STOP
        fi };
        if
        :: wanted == STOP ->
            exchange(no_number, STOP, id)
        :: else ->
            if
            :: !session ->
                atomic {
                    if /* a random one */
                    :: number = 1
                    :: number = 2
                    :: number = 3
                    fi
                }
#ifndef PLANT_NO_VERSION
                exchange(number, VERSION, NO_ID);
                session = answered
#else
                session = true
#endif
            :: else
            fi;
            if
            :: session ->
                number = number % NUMBERS + 1;
                exchange(number, wanted, id);
                session = answered;
                /* The answer is the one to this very action, which has been executed. */
#ifndef AT_MOST_ONCE
                assert(!answered || got_id == id);
#endif
                assert(!answered || wanted != SET || got_id != id || in_all[id] > 0)
            :: else
            fi
        fi
    :: else -> break
    od
}

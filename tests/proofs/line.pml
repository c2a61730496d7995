/*
 * The line between one master and one unit (firmware/rkm04/docs/line.md, "Sessions"), for Spin.
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
 * Switches. LATE: the master may stop waiting, and start anew, while frames are still under way. PLANT_...: an error,
 * to see that it is found.
 */
#ifndef ACTIONS
#define ACTIONS 3
#endif
#ifndef UNIT_STARTS
#define UNIT_STARTS 1 /* besides the first */
#endif
#define ATTEMPTS 2
#define NUMBERS 3       /* 255 on the line; fewer meet again sooner */
#define REPETITIONS 1   /* by the line itself */
#define NO_NUMBER 0
#define NO_ID 0

mtype = { VERSION, SET, READ, STOP, BROADCAST, REFUSED };

/* number, message, whose it is (of an answer: what was executed for it), whether it is damaged */
chan requests = [2] of { byte, mtype, byte, bool };
chan answers = [2] of { byte, mtype, byte, bool };

byte executed[ACTIONS + 1]; /* how often the unit has executed each action, in all its lives */
byte repetitions = REPETITIONS;
byte unit_starts = UNIT_STARTS;
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
    bool damaged, open = false; /* a session: a Version has come since the start */

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
#ifndef PLANT_NO_REFUSAL
            :: !open && number != NO_NUMBER && message != VERSION -> carry(answers, number, REFUSED, NO_ID)
#endif
            :: else ->
                assert(!damaged);
                assert(message != SET || executed[id] == 0);
                if
                :: message == SET -> executed[id]++
                :: else
                fi;
                open = open || message == VERSION;
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
            kept_number = NO_NUMBER; kept_id = NO_ID; kept_message = VERSION; open = false
        }
    od
}

#ifdef LATE
#define NOTHING_COMES true
#else
#define NOTHING_COMES (empty(requests) && empty(answers))
#endif

/* Sends a request until an answer to it comes, ATTEMPTS times; `answered` and `refused` tell. */
inline exchange(number, message, id)
{
    answered = false;
    refused = false;
    attempts = ATTEMPTS;
    do
    :: attempts > 0 && !answered && !refused ->
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
            :: !damaged && got_number == number && got_message == REFUSED -> refused = true; break
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
    bool session = false, answered, refused, damaged;
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
again:      if
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
#ifndef PLANT_ONE_VERSION
                if
                :: answered ->
                    number = number % NUMBERS + 1;
                    exchange(number, VERSION, NO_ID)
                :: else
                fi;
#endif
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
                assert(!answered || got_id == id);
                assert(!answered || wanted != SET || executed[id] > 0);
                /* What is refused when it is sent for the first time has not been, if the line repeats nothing. */
                assert(!refused || attempts < ATTEMPTS - 1 || repetitions < REPETITIONS || executed[id] == 0);
                if
#ifdef PLANT_SENT_AGAIN
                :: refused -> goto again
#else
                :: refused && wanted == READ -> goto again
#endif
                :: else
                fi
            :: else
            fi
        fi
    :: else -> break
    od
}

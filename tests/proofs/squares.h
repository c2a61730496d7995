/*
 * Quotients, products and squares of whole numbers. Provers find these lemmas by the predicates' names.
 */
#ifndef SQUARES_H
#define SQUARES_H

/*@ predicate ordered_by(integer a, integer b, integer factor) = a <= b && 0 <= factor;
    lemma ordered_by: \forall integer a, b, factor; ordered_by(a, b, factor) ==> a * factor <= b * factor;
    predicate cancelled(integer factor, integer x, integer most) = 1 <= factor && factor * x <= factor * most;
    lemma cancelled: \forall integer factor, x, most; cancelled(factor, x, most) ==> x <= most;
    predicate opposite(integer a, integer b) = 0 <= a && b <= 0;
    lemma opposite: \forall integer a, b; opposite(a, b) ==> a * b <= 0;

    logic integer square(integer x) = x * x;
    lemma square_positive: \forall integer x; 0 <= square(x);
    lemma square_double: \forall integer x; square(2 * x) == 4 * square(x);
    lemma square_product: \forall integer a, b; square(2 * (a * b)) == 4 * (square(b) * square(a));
    lemma square_sum: \forall integer a, b; square(a + b) == square(a - b) + 4 * (a * b);
    predicate ordered(integer a, integer b) = 0 <= a <= b;
    lemma ordered: \forall integer a, b; ordered(a, b) ==> square(a) <= square(b);
    predicate within(integer x, integer most) = -most <= x <= most;
    lemma within: \forall integer x, most; within(x, most) ==> square(x) <= square(most);
    predicate parts(integer a, integer b, integer sum) = a + b == sum;
    lemma parts: \forall integer a, b, sum; parts(a, b, sum) ==> 4 * (a * b) <= square(sum);

    predicate split(integer x, integer y, integer quotient, integer rest) =
        x == quotient * y + rest && 0 <= quotient && 0 <= rest < y;
    lemma split: \forall integer x, y; 0 <= x && 1 <= y ==> split(x, y, x / y, x % y);
    lemma split_above: \forall integer x, y, quotient, rest; split(x, y, quotient, rest) ==> x < y * (quotient + 1);
    lemma split_least: \forall integer x, y, quotient, rest; split(x, y, quotient, rest) ==> quotient * y <= x;
    lemma split_ordered: \forall integer x, y, quotient, rest; split(x, y, quotient, rest) && quotient < y ==>
        ordered_by(quotient + 1, y, y);
    lemma split_less: \forall integer x, y, quotient, rest; split(x, y, quotient, rest) && quotient < y ==>
        x < square(y);
    lemma split_enough: \forall integer x, y, quotient, rest; split(x, y, quotient, rest) && y <= quotient ==>
        square(y) <= x;

    predicate root_found(integer value, integer root) = square(root) <= value < square(root + 1);
*/
#endif

/** The service, or the page without one, does not do this; the message is why. */
export class Refused extends Error {}

/** Made by build.mjs of machine.schema.json. */
declare module "machine-rules" {
    export interface RuleError {
        /** Such as /motors/0/limits */
        instancePath: string;
        keyword: string;
        params: Record<string, unknown>;
    }
    const validate: ((content: unknown) => boolean) & { errors: RuleError[] | null };
    export default validate;
}

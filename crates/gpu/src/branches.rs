/*!
No shader branches on uniforms alone. Lavapipe of Mesa 22 writes the values of such uniforms into the
shader, and compiles it anew whenever any of them changes: a tenth of a second for each view, and memory
that is never given back. What is the same for all invocations is chosen by `select` instead.

What a function is given counts as different for each invocation.
*/

use crate::shaders::{everything, module, sources};
use naga::{AddressSpace, Block, Expression, Function, Handle, Module, Statement};

/// What an expression hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source {
    Constants,
    Uniforms,
    Invocations,
}

/// What an expression of a function hangs on.
fn source(module: &Module, function: &Function, of: Handle<Expression>) -> Source {
    let most = |of: &[Handle<Expression>]| {
        let sources = of.iter().map(|&of| source(module, function, of));
        sources.max().unwrap_or(Source::Constants)
    };
    match &function.expressions[of] {
        Expression::Literal(_)
        | Expression::Constant(_)
        | Expression::Override(_)
        | Expression::ZeroValue(_) => Source::Constants,
        Expression::GlobalVariable(variable) => {
            let is_uniform = module.global_variables[*variable].space == AddressSpace::Uniform;
            if is_uniform { Source::Uniforms } else { Source::Invocations }
        }
        Expression::Load { pointer: of }
        | Expression::AccessIndex { base: of, .. }
        | Expression::Splat { value: of, .. }
        | Expression::Swizzle { vector: of, .. }
        | Expression::Unary { expr: of, .. }
        | Expression::Relational { argument: of, .. }
        | Expression::As { expr: of, .. } => most(&[*of]),
        Expression::Access { base: a, index: b } | Expression::Binary { left: a, right: b, .. } => {
            most(&[*a, *b])
        }
        Expression::Select { condition, accept, reject } => most(&[*condition, *accept, *reject]),
        Expression::Compose { components, .. } => most(components),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            most(&[Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect::<Vec<_>>())
        }
        Expression::CallResult(called) => returned(module, &module.functions[*called]),
        _ => Source::Invocations,
    }
}

/// What the results of a function hang on.
fn returned(module: &Module, function: &Function) -> Source {
    let mut found = Source::Constants;
    each(&function.body, &mut |statement| {
        if let Statement::Return { value: Some(value) } = statement {
            found = found.max(source(module, function, *value));
        }
    });
    found
}

/// Visits all statements of a block.
fn each<'a>(block: &'a Block, visit: &mut impl FnMut(&'a Statement)) {
    for statement in block {
        visit(statement);
        match statement {
            Statement::Block(block) => each(block, visit),
            Statement::If { accept, reject, .. } => {
                each(accept, visit);
                each(reject, visit);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|it| each(&it.body, visit)),
            Statement::Loop { body, continuing, .. } => {
                each(body, visit);
                each(continuing, visit);
            }
            _ => {}
        }
    }
}

/// How many branches of a module hang on uniforms alone.
fn on_uniforms(module: &Module) -> usize {
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    let functions = module.functions.iter().map(|(_, function)| function).chain(entries);
    let mut count = 0;
    for function in functions {
        each(&function.body, &mut |statement| {
            let of = match statement {
                Statement::If { condition: of, .. } | Statement::Switch { selector: of, .. } => *of,
                Statement::Loop { break_if: Some(of), .. } => *of,
                _ => return,
            };
            count += usize::from(source(module, function, of) == Source::Uniforms);
        });
    }
    count
}

#[test]
fn nothing_branches_on_uniforms_alone() {
    for (name, source) in sources() {
        let module = module(&name, &source, everything()).unwrap();
        assert_eq!(on_uniforms(&module), 0, "{name}");
    }
}

#[test]
fn branches_on_uniforms_are_found() {
    let source = "
        struct Camera { near: f32, is_wide: u32 }
        @group(0) @binding(0) var<uniform> camera: Camera;
        @group(0) @binding(1) var<storage, read_write> out: array<f32>;
        fn is_wide() -> bool { return camera.is_wide != 0u; }
        @compute @workgroup_size(1)
        fn main(@builtin(local_invocation_index) lane: u32) {
            if is_wide() { out[0] = 1.0; }
            if camera.near * 2.0 < 1.0 { out[1] = 1.0; }
            if lane > camera.is_wide { out[2] = 1.0; }
            if out[3] > 1.0 { out[3] = select(1.0, 2.0, is_wide()); }
        }";
    let module = module("test", source, everything()).unwrap();
    assert_eq!(on_uniforms(&module), 2);
}

/*!
The text that names a synthetic scene: `hall:n=1e7,seed=3`.

A kind of scene has a table of keys; one parser reads every scene by its table. So what the help
says, what is accepted and what an error tells are one and the same.
*/

use crate::error::quote;
use puncta_core::MAX_RECORDS;
use std::fmt;

/// A kind of scene that can be generated, as a list for users tells it.
#[derive(Debug)]
#[non_exhaustive]
pub struct Kind {
    /// The name that a spec starts with.
    pub name: &'static str,
    /// What it is, in a line.
    pub about: &'static str,
    /// What can be set; every kind has `n`, `r` and `seed`.
    pub keys: &'static [Key],
}

/// Something that can be set in a scene.
#[derive(Debug)]
#[non_exhaustive]
pub struct Key {
    /// The name in a spec, before the equals sign.
    pub name: &'static str,
    /// What it sets, in a few words.
    pub about: &'static str,
    /// The value it has when it is not given: a value, or a formula for one.
    pub default: &'static str,
    pub(super) domain: Domain,
    pub(super) derive: Option<fn(&Spec) -> f64>,
}

impl Key {
    /// A key whose default is a value.
    pub(super) const fn new(
        name: &'static str,
        domain: Domain,
        default: &'static str,
        about: &'static str,
    ) -> Self {
        Self { name, about, default, domain, derive: None }
    }

    /// The number of records.
    pub(super) const fn count(default: &'static str) -> Self {
        let records = Domain::Count { min: 1, max: MAX_RECORDS as u64 };
        Self::new("n", records, default, "number of records")
    }

    /// The seed of the random numbers.
    pub(super) const fn seed() -> Self {
        Self::new("seed", Domain::Seed, "1", "seed of the random numbers")
    }

    /// A length that follows from the keys before it, by the formula in the text.
    pub(super) const fn derived(
        name: &'static str,
        formula: &'static str,
        derive: fn(&Spec) -> f64,
        about: &'static str,
    ) -> Self {
        let derive = Some(derive);
        Self { name, about, default: formula, domain: Domain::Length, derive }
    }

    /// The values it can take, as in `n must be ...`.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self.domain {
            Domain::Count { min, max } => format!("a whole number from {min} to {max}"),
            Domain::Seed => format!("a whole number from 0 to {}", u64::MAX),
            Domain::Length => format!("a number from {LENGTH_MIN:e} to {LENGTH_MAX:e}"),
            Domain::Share => "a number from 0 to 1".to_owned(),
            Domain::Word(words) => format!("one of {}", words.join(", ")),
        }
    }
}

/// Which values a key can take.
#[derive(Clone, Copy, Debug)]
pub(super) enum Domain {
    /// How many there are of something.
    Count { min: u64, max: u64 },
    /// Any 64 bits.
    Seed,
    /// A length that leaves room to compute with.
    Length,
    /// A number from 0 to 1.
    Share,
    /// One of these.
    Word(&'static [&'static str]),
}

const LENGTH_MIN: f64 = 1e-30;
const LENGTH_MAX: f64 = 1e30;

/// The value of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Whole(u64),
    Number(f64),
    Word(&'static str),
}

impl Domain {
    fn parse(self, text: &str) -> Option<Value> {
        match self {
            Self::Count { min, max } => {
                let count = parse_whole(text)?;
                (min..=max).contains(&count).then_some(Value::Whole(count))
            }
            Self::Seed => parse_whole(text).map(Value::Whole),
            Self::Length => parse_number(text, LENGTH_MIN, LENGTH_MAX),
            Self::Share => parse_number(text, 0.0, 1.0),
            Self::Word(words) => words.iter().find(|word| **word == text).map(|w| Value::Word(w)),
        }
    }
}

/// A whole number: digits, or with an exponent as in `2.5e6`.
fn parse_whole(text: &str) -> Option<u64> {
    if text.bytes().all(|byte| byte.is_ascii_digit()) {
        return text.parse().ok();
    }
    // Whole numbers up to 2^53 are exact in f64; above, an exponent would promise digits.
    let Value::Number(number) = parse_number(text, 0.0, (1_u64 << 53) as f64)? else { return None };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 0..=2^53")]
    (number.fract() == 0.0).then_some(number as u64)
}

fn parse_number(text: &str, min: f64, max: f64) -> Option<Value> {
    let number: f64 = fast_float2::parse(text).ok()?;
    (min..=max).contains(&number).then_some(Value::Number(number))
}

/// A length by formula, cut to three digits and to what can be given.
fn short(number: f64) -> f64 {
    let rounded = fast_float2::parse(format!("{number:.2e}")).unwrap_or(number);
    rounded.clamp(LENGTH_MIN, LENGTH_MAX)
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(whole) => write!(f, "{whole}"),
            Self::Number(number) if (1e-4..1e7).contains(number) || *number == 0.0 => {
                write!(f, "{number}")
            }
            Self::Number(number) => write!(f, "{number:e}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}

/// What is wrong with the text that names a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SpecError {
    /// There is no scene of this name.
    #[error("there is no scene {name}; there are {known}")]
    UnknownKind {
        /// The name, in quotes.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// A setting is not a key, an equals sign and a value.
    #[error("a setting of {kind} must be of the form key=value, not {text}")]
    Form {
        /// The name of the scene.
        kind: &'static str,
        /// The setting, in quotes.
        text: String,
    },
    /// The scene has no such key.
    #[error("{kind} has no key {key}; its keys are {known}")]
    UnknownKey {
        /// The name of the scene.
        kind: &'static str,
        /// The key, in quotes.
        key: String,
        /// The keys of this scene.
        known: String,
    },
    /// A key is given a second time.
    #[error("{key} of {kind} is given twice")]
    Twice {
        /// The name of the scene.
        kind: &'static str,
        /// The key.
        key: &'static str,
    },
    /// A value is not what it must be.
    #[error("{key} of {kind} must be {allowed}, not {value}")]
    Value {
        /// The name of the scene.
        kind: &'static str,
        /// The key.
        key: &'static str,
        /// The value, in quotes.
        value: String,
        /// The values that can be given.
        allowed: String,
    },
}

/// A kind of scene and the values of all its keys.
#[derive(Clone, Debug)]
pub(super) struct Spec {
    kind: &'static Kind,
    /// One for each key of the kind, in their order.
    values: Vec<Value>,
}

impl Spec {
    pub(super) fn parse(text: &str, kinds: &'static [Kind]) -> Result<Self, SpecError> {
        let (name, settings) = match text.split_once(':') {
            Some((name, settings)) => (name, Some(settings)),
            None => (text, None),
        };
        let kind = kinds.iter().find(|kind| kind.name == name).ok_or_else(|| {
            let known = list(kinds.iter().map(|kind| kind.name));
            SpecError::UnknownKind { name: quote(name.as_bytes()), known }
        })?;
        let mut given = vec![None; kind.keys.len()];
        for setting in settings.into_iter().flat_map(|settings| settings.split(',')) {
            kind.read_setting(setting, &mut given)?;
        }
        let mut spec = Self { kind, values: Vec::with_capacity(given.len()) };
        for (key, value) in kind.keys.iter().zip(given) {
            // Formulas look back at the keys before theirs, which have their values by now.
            let value = match (value, key.derive) {
                (Some(value), _) => value,
                (None, Some(derive)) => Value::Number(short(derive(&spec))),
                (None, None) => kind.value(key, key.default)?,
            };
            spec.values.push(value);
        }
        Ok(spec)
    }

    pub(super) const fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// The number of records.
    pub(super) fn count(&self) -> u64 {
        self.whole("n")
    }

    pub(super) fn seed(&self) -> u64 {
        self.whole("seed")
    }

    /// The radius of a record.
    pub(super) fn radius(&self) -> f32 {
        super::random::single(self.number("r"))
    }

    pub(super) fn number(&self, key: &str) -> f64 {
        match self.value(key) {
            Value::Number(number) => number,
            Value::Whole(whole) => whole as f64,
            Value::Word(_) => unreachable!("{key} is a word"),
        }
    }

    pub(super) fn word(&self, key: &str) -> &'static str {
        match self.value(key) {
            Value::Word(word) => word,
            _ => unreachable!("{key} is a number"),
        }
    }

    pub(super) fn whole(&self, key: &str) -> u64 {
        match self.value(key) {
            Value::Whole(whole) => whole,
            _ => unreachable!("{key} is not a whole number"),
        }
    }

    fn value(&self, key: &str) -> Value {
        let mut pairs = self.kind.keys.iter().zip(&self.values);
        match pairs.find(|(candidate, _)| candidate.name == key) {
            Some((_, value)) => *value,
            None => unreachable!("{} has no key {key}", self.kind.name),
        }
    }
}

impl Kind {
    fn read_setting(
        &'static self,
        setting: &str,
        given: &mut [Option<Value>],
    ) -> Result<(), SpecError> {
        let kind = self.name;
        let (name, text) = setting
            .split_once('=')
            .ok_or_else(|| SpecError::Form { kind, text: quote(setting.as_bytes()) })?;
        let mut slots = self.keys.iter().zip(given);
        let (key, slot) = slots.find(|(key, _)| key.name == name).ok_or_else(|| {
            let known = list(self.keys.iter().map(|key| key.name));
            SpecError::UnknownKey { kind, key: quote(name.as_bytes()), known }
        })?;
        match slot.replace(self.value(key, text)?) {
            None => Ok(()),
            Some(_) => Err(SpecError::Twice { kind, key: key.name }),
        }
    }

    fn value(&self, key: &'static Key, text: &str) -> Result<Value, SpecError> {
        key.domain.parse(text).ok_or_else(|| SpecError::Value {
            kind: self.name,
            key: key.name,
            value: quote(text.as_bytes()),
            allowed: key.allowed(),
        })
    }
}

impl fmt::Display for Spec {
    /// The whole spec: every key, with the value it has.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.name)?;
        for (i, (key, value)) in self.kind.keys.iter().zip(&self.values).enumerate() {
            write!(f, "{}{}={value}", if i == 0 { ':' } else { ',' }, key.name)?;
        }
        Ok(())
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

//! From tokens to entities: the syntax of a map, and the planes, but no meaning of names yet.

use std::borrow::Cow;

use glam::{DVec2, DVec3};
use planecut_kernel::HalfSpace;
use winnow::Parser;
use winnow::combinator::delimited;
use winnow::stream::Location;
use winnow::token::any;

use super::decimal::Decimal;
use super::error::{Found, SyntaxError};
use super::plane::{self, PlaneError, Point};
use super::texture::Alignment;
use super::token::{Input, Parsed, is_delimiter, name, number, peek, punctuation, quoted, word};

/// An entity, or a brush that stands outside any.
#[derive(Debug, Default)]
pub(super) struct Entity<'a> {
    /// Whether this is only a brush, or a primitive, outside any entity.
    pub(super) is_bare: bool,
    /// The last value of `classname`.
    pub(super) classname: Option<Cow<'a, [u8]>>,
    /// The last value of `origin` that is three numbers.
    origin: Option<Point>,
    pub(super) brushes: Vec<Brush<'a>>,
    pub(super) left_out: Vec<LeftOut>,
}

/// A brush.
#[derive(Debug)]
pub(super) struct Brush<'a> {
    /// Offset of its opening brace.
    pub(super) offset: usize,
    pub(super) faces: Vec<Face<'a>>,
}

/// One face.
#[derive(Debug)]
pub(super) struct Face<'a> {
    /// Offset of its first parenthesis.
    pub(super) offset: usize,
    pub(super) plane: Result<HalfSpace, PlaneError>,
    /// The plane as it is stated, where that is by four numbers.
    equation: Option<[Decimal; 4]>,
    pub(super) texture: Cow<'a, [u8]>,
    /// How the texture lies.
    pub(super) alignment: Alignment,
    /// The place from which the texture is laid.
    pub(super) origin: DVec3,
}

/// A primitive that is not read.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeftOut {
    /// Offset of its keyword.
    pub(super) offset: usize,
    /// Whether it is a curved patch.
    pub(super) is_patch: bool,
}

/// The next entity; `None` at the end of the text.
pub(super) fn entity<'a>(input: &mut Input<'a>) -> Parsed<Option<Entity<'a>>> {
    version(input)?;
    if peek(input)?.is_none() {
        return Ok(None);
    }
    let opened = open_brace(input)?;
    let mut entity = Entity::default();
    if peek(input)?.is_some_and(|byte| byte == b'(' || byte.is_ascii_alphabetic()) {
        entity.is_bare = true;
        brush_or_primitive(input, opened, &mut entity)?;
        return Ok(Some(entity));
    }
    loop {
        match peek(input)? {
            Some(b'"') => {
                let (key, value) = (quoted, quoted).parse_next(input)?;
                match &*key {
                    b"classname" => entity.classname = Some(value),
                    b"origin" => entity.origin = point_of(&value).or(entity.origin),
                    _ => {}
                }
            }
            Some(b'{') => {
                let opened = open_brace(input)?;
                brush_or_primitive(input, opened, &mut entity)?;
            }
            _ => {
                close_brace(input, opened, "a key in quotes, `{` or `}`")?;
                entity.put_in_place();
                return Ok(Some(entity));
            }
        }
    }
}

impl Entity<'_> {
    /// Moves what Doom 3 states relative to the origin of its entity: planes of four numbers, and textures on them. The world has no origin.
    fn put_in_place(&mut self) {
        let Some(origin) = self.origin.filter(|_| self.classname.as_deref() != Some(b"worldspawn")) else { return };
        for face in self.brushes.iter_mut().flat_map(|brush| &mut brush.faces) {
            if let Some(equation) = &face.equation {
                face.plane = plane::half_space_of(equation, &origin);
                face.origin = DVec3::from_array(origin.map(Decimal::to_f64));
            }
        }
    }
}

/// Three numbers between blanks.
fn point_of(text: &[u8]) -> Option<Point> {
    let mut numbers = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).map(Decimal::parse);
    let point = [numbers.next()??, numbers.next()??, numbers.next()??];
    numbers.next().is_none().then_some(point)
}

/// The first line of a Doom 3 map, `Version 2`.
fn version(input: &mut Input<'_>) -> Parsed<()> {
    if peek(input)? == Some(b'V') && input.starts_with(b"Version") {
        (word, number).void().parse_next(input)?;
    }
    Ok(())
}

fn open_brace(input: &mut Input<'_>) -> Parsed<usize> {
    peek(input)?;
    let opened = input.current_token_start();
    punctuation(b'{', "`{`").parse_next(input)?;
    Ok(opened)
}

/// Takes `}`; an error says `expected` and where the brace was opened.
fn close_brace(input: &mut Input<'_>, opened: usize, expected: &'static str) -> Parsed<()> {
    punctuation(b'}', expected).parse_next(input).map_err(|error| SyntaxError { opened: Some(opened), ..error })
}

/// What follows the opening brace of a brush, its closing brace included.
fn brush_or_primitive<'a>(input: &mut Input<'a>, opened: usize, entity: &mut Entity<'a>) -> Parsed<()> {
    if !peek(input)?.is_some_and(|byte| byte.is_ascii_alphabetic()) {
        entity.brushes.push(Brush { offset: opened, faces: faces(input, opened, Form::Points)? });
        return Ok(());
    }
    let offset = input.current_token_start();
    let keyword = word(input)?;
    let form = if keyword.eq_ignore_ascii_case(b"brushDef") {
        Some(Form::PointsAndMatrix)
    } else if keyword.eq_ignore_ascii_case(b"brushDef3") {
        Some(Form::EquationAndMatrix)
    } else {
        None
    };
    if let Some(form) = form {
        let inner = open_brace(input)?;
        entity.brushes.push(Brush { offset: opened, faces: faces(input, inner, form)? });
    } else {
        skip_block(input)?;
        let is_patch = keyword.get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"patch"));
        entity.left_out.push(LeftOut { offset, is_patch });
    }
    close_brace(input, opened, "`}`")
}

/// Skips a block in braces, whatever it holds. Counts braces instead of recursing: depth costs nothing.
fn skip_block(input: &mut Input<'_>) -> Parsed<()> {
    let opened = open_brace(input)?;
    let mut depth = 1_usize;
    while depth > 0 {
        match peek(input)? {
            None => return close_brace(input, opened, "`}`"),
            Some(b'"') => quoted.void().parse_next(input)?,
            Some(byte) if is_delimiter(byte) => {
                any.void().parse_next(input)?;
                match byte {
                    b'{' => depth += 1,
                    b'}' => depth -= 1,
                    _ => {}
                }
            }
            Some(_) => word.void().parse_next(input)?,
        }
    }
    Ok(())
}

/// How a face states its plane, and whether a texture matrix follows.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// Three points.
    Points,
    /// Three points and a matrix (`brushDef`).
    PointsAndMatrix,
    /// Four numbers and a matrix (`brushDef3`).
    EquationAndMatrix,
}

/// Faces up to the closing brace, which is taken.
fn faces<'a>(input: &mut Input<'a>, opened: usize, form: Form) -> Parsed<Vec<Face<'a>>> {
    let mut faces = Vec::with_capacity(6);
    while peek(input)? == Some(b'(') {
        faces.push(face(input, form)?);
    }
    close_brace(input, opened, "`(` or `}`")?;
    Ok(faces)
}

fn face<'a>(input: &mut Input<'a>, form: Form) -> Parsed<Face<'a>> {
    let offset = input.current_token_start();
    let (plane, equation) = plane_of_face(input, form)?;
    let has_matrix = form != Form::Points;
    let matrix = if has_matrix { Some(matrix(input)?) } else { None };
    let texture = name(input)?;
    let (layout, axes) = if has_matrix {
        (Layout::Matrix, None)
    } else if peek(input)? == Some(b'[') {
        (Layout::Axes, Some((axis, axis).parse_next(input)?))
    } else {
        (Layout::Plain, None)
    };
    let values = values(input, offset, layout)?;
    let alignment = match (matrix, axes) {
        (Some((u, v)), _) => Alignment::Matrix { u, v },
        (None, Some((u, v))) => Alignment::Axes { u, v, scale: DVec2::new(values[1], values[2]) },
        (None, None) => {
            let [x, y, degrees, wide, high, ..] = values;
            Alignment::Plain { shift: DVec2::new(x, y), degrees, scale: DVec2::new(wide, high) }
        }
    };
    Ok(Face { offset, plane, equation, texture, alignment, origin: DVec3::ZERO })
}

/// The plane of a face, and the four numbers that state it, where they do.
type StatedPlane = (Result<HalfSpace, PlaneError>, Option<[Decimal; 4]>);

fn plane_of_face(input: &mut Input<'_>, form: Form) -> Parsed<StatedPlane> {
    if form == Form::EquationAndMatrix {
        let equation = quadruple(input)?;
        let nowhere = [Decimal::Exact { mantissa: 0, places: 0 }; 3];
        return Ok((plane::half_space_of(&equation, &nowhere), Some(equation)));
    }
    let points: [Point; 3] = (triple, triple, triple).map(<[Point; 3]>::from).parse_next(input)?;
    Ok((plane::half_space(&points), None))
}

/// `( a b c d )`.
fn quadruple(input: &mut Input<'_>) -> Parsed<[Decimal; 4]> {
    let numbers = (number, number, number, number).map(<[Decimal; 4]>::from);
    delimited(punctuation(b'(', "`(`"), numbers, punctuation(b')', "`)`")).parse_next(input)
}

/// `( x y z )`.
fn triple(input: &mut Input<'_>) -> Parsed<Point> {
    let numbers = (number, number, number).map(Point::from);
    delimited(punctuation(b'(', "`(`"), numbers, punctuation(b')', "`)`")).parse_next(input)
}

/// `( ( a b c ) ( a b c ) )`.
fn matrix(input: &mut Input<'_>) -> Parsed<(DVec3, DVec3)> {
    let rows = (triple, triple).map(|rows: (Point, Point)| {
        let row = |[a, b, c]: Point| DVec3::new(a.to_f64(), b.to_f64(), c.to_f64());
        (row(rows.0), row(rows.1))
    });
    delimited(punctuation(b'(', "`(`"), rows, punctuation(b')', "`)`")).parse_next(input)
}

/// `[ x y z offset ]`.
fn axis(input: &mut Input<'_>) -> Parsed<(DVec3, f64)> {
    let numbers = (number, number, number, number);
    let numbers = numbers.map(|(x, y, z, offset)| (DVec3::new(x.to_f64(), y.to_f64(), z.to_f64()), offset.to_f64()));
    delimited(punctuation(b'[', "`[`"), numbers, punctuation(b']', "`]`")).parse_next(input)
}

/// How a face lays on its texture.
#[derive(Clone, Copy)]
enum Layout {
    /// By shift, rotation and scale.
    Plain,
    /// By two axes with their shifts, rotation and scale.
    Axes,
    /// By a matrix alone.
    Matrix,
}

impl Layout {
    /// How many values follow: those of the layout alone, with Hexen II's one, Quake 2's three, or Daikatana's six.
    fn counts(self) -> ([usize; 4], &'static str) {
        match self {
            Self::Plain => ([5, 6, 8, 11], "5, 6, 8 or 11"),
            Self::Axes => ([3, 4, 6, 9], "3, 4, 6 or 9"),
            Self::Matrix => ([0, 1, 3, 6], "0, 1, 3 or 6"),
        }
    }
}

/// The numbers at the end of a face, counted, and the first of them; `face` is where the face begins.
fn values(input: &mut Input<'_>, face: usize, layout: Layout) -> Parsed<[f64; 5]> {
    let mut first = [0.0; 5];
    let mut count = 0;
    while peek(input)?.is_some_and(|byte| !is_delimiter(byte)) {
        let number = number(input)?;
        if let Some(value) = first.get_mut(count) {
            *value = number.to_f64();
        }
        count += 1;
    }
    let (accepted, expected) = layout.counts();
    if accepted.contains(&count) {
        return Ok(first);
    }
    Err(SyntaxError { offset: face, found: Found::Values(count), expected, opened: None })
}
